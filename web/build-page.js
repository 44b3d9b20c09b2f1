// Builds the page that checks: `npm run page -- PROGRAM.wasm OUT.html`; .ci/page makes both.
//
// One file: the program, compiled for WASI, as gzip in base 64; the worker that runs it; the page around them.

import { build } from 'esbuild';
import { readFile, writeFile } from 'node:fs/promises';
import { gzipSync } from 'node:zlib';

const [program, out] = process.argv.slice(2);
if (!out) {
  console.error('usage: npm run page -- PROGRAM.wasm OUT.html');
  process.exit(2);
}
const here = new URL('.', import.meta.url).pathname;
const shim = await readFile(new URL('node_modules/@bjorn3/browser_wasi_shim/LICENSE-MIT', import.meta.url), 'utf8');

/** The text of an entry and all that it imports. */
async function bundled(entry) {
  const built = await build({
    entryPoints: [`page/${entry}`], absWorkingDir: here, outdir: 'out', bundle: true, minify: true, format: 'iife', target: 'es2022', charset: 'ascii', legalComments: 'none', write: false,
  });
  // Inside <script> and <style> nothing may look like their end, or like a comment of HTML.
  return built.outputFiles[0].text.replace(/<\/(script|style)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');
}

const parts = {
  STYLE: await bundled('style.css'),
  PROGRAM: gzipSync(await readFile(program), { level: 9 }).toString('base64'),
  WORKER: `/*!\nThis contains browser_wasi_shim:\n\n${shim}*/\n${await bundled('worker.js')}`,
  MAIN: await bundled('main.js'),
};
const template = await readFile(new URL('page/index.html', import.meta.url), 'utf8');
const page = template.replace(/\/\*([A-Z]+)\*\//g, (_, name) => parts[name]);
await writeFile(out, page);
console.log(`${out}: ${page.length} bytes`);
