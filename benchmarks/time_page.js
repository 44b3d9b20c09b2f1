// How long the page takes from a file's being dropped to its answer: `node benchmarks/time_page.js`, after .ci/page.
//
// The file is the scene cloth, 79,202 triangles, at its last step, as the example write_obj writes it (`cargo build --release
// -p pliant-scenes --example write_obj`). Five pages are opened anew; the median counts. Needs Chromium, see web/browser.js.

import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { cpus, tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { launch } from '../web/browser.js';

const root = fileURLToPath(new URL('..', import.meta.url));
const page = pathToFileURL(join(root, 'target/page/check.html')).href;
const writer = process.env.WRITE_OBJ ?? join(root, 'target/release/examples/write_obj');
const folder = mkdtempSync(join(tmpdir(), 'pliant-time-page-'));
try {
  const written = spawnSync(writer, ['cloth', '79202', '50', folder], { encoding: 'utf8' });
  if (written.status !== 0) throw new Error(`${writer}: ${written.stderr ?? written.error}`);
  const browser = await launch();
  const times = [];
  for (let round = 0; round < 5; round += 1) {
    const tab = await browser.newPage({ offline: true });
    await tab.goto(page);
    await tab.waitForSelector('body[data-state=ready]');
    await tab.setInputFiles('#files', [join(folder, 'cloth-0.obj')]);
    await tab.waitForSelector('body[data-state=done]', { timeout: 120_000 });
    const { ms, code } = await tab.evaluate(() => ({ ...document.body.dataset }));
    if (code !== '1') throw new Error(`exit code ${code}`);
    times.push(Number(ms));
    console.log(`round ${round}: ${ms} ms`);
    await tab.close();
  }
  await browser.close();
  times.sort((a, b) => a - b);
  console.log(`cloth, 79,202 triangles, one file: ${times[2]} ms from drop to answer (median of 5; ${cpus().length} cores)`);
} finally {
  rmSync(folder, { recursive: true, force: true });
}
