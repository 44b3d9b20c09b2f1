// Builds the viewer into crates/pliant-report/assets, where Rust takes it from: `npm ci && npm run build`.
// With --check nothing is written: fails if what is checked in is not what these sources give.

import { build } from 'esbuild';
import { readFile, writeFile } from 'node:fs/promises';

const assets = new URL('../crates/pliant-report/assets/', import.meta.url);
const licence = (name) => readFile(new URL(`node_modules/${name}/LICENSE`, import.meta.url), 'utf8');

// Minified code loses its comments; the licences ask to stay with it.
const banner = `/*!\nThis page contains three.js:\n\n${await licence('three')}\nand uPlot:\n\n${await licence('uplot')}*/`;

const built = await build({
  entryPoints: [{ in: 'src/main.js', out: 'viewer' }, { in: 'src/style.css', out: 'viewer' }],
  absWorkingDir: new URL('.', import.meta.url).pathname,
  outdir: 'out',
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2022',
  charset: 'ascii',
  legalComments: 'none',
  banner: { js: banner },
  write: false,
});

let stale = false;
for (const file of built.outputFiles) {
  const name = file.path.split(/[\\/]/).pop();
  // Inside <script> and <style> nothing may look like their end, or like a comment of HTML.
  const text = file.text.replace(/<\/(script|style)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');
  const path = new URL(name, assets);
  if (process.argv.includes('--check')) {
    if (text !== (await readFile(path, 'utf8'))) {
      console.error(`${name} is not what its sources give; run npm run build`);
      stale = true;
    }
  } else {
    await writeFile(path, text);
    console.log(`${name}: ${text.length} bytes`);
  }
}
process.exitCode = stale ? 1 : 0;
