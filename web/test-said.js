// What the page takes from the JSON as it comes, however it is cut; no browser.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Said } from './page/said.js';

const HEAD = '{"format":1,"bodies":[{"name":"\u00e9{\\"frame\\":1,"},{"name":"b"}],"frames":[\n';
const FRAMES = ['{"frame":0,"count":0,"inside":[]},', '{"frame":0,"until":12,"count":2},', '{"frame":12,"count":1,"inside":[[1,0,0]]}'];
const TEXT = `${HEAD}${FRAMES.join('\n')}\n],"places":[]}\n`;

/** What is known after these bytes, in pieces of a length. */
function taken(text, length) {
  const said = new Said();
  const bytes = new TextEncoder().encode(text);
  for (let at = 0; at < bytes.length; at += length) said.take(bytes.slice(at, at + length));
  assert.equal(Buffer.concat(said.pieces).toString(), text);
  return [said.bodies, said.frames, said.inside];
}

test('bodies, frames and what lies inside, wherever pieces end', () => {
  for (let length = 1; length <= TEXT.length; length += 1) {
    assert.deepEqual(taken(TEXT, length), [2, 2, true], `pieces of ${length}`);
    assert.deepEqual(taken(TEXT.replace('[[1,0,0]]', '[]'), length), [2, 2, false]);
  }
  assert.deepEqual(taken(HEAD, 7), [2, 0, false]);
});

test('a frame of many pairs is not looked at again for each piece', () => {
  const said = new Said();
  const encoder = new TextEncoder();
  said.take(encoder.encode(`${HEAD}{"frame":0,"count":9,"pairs":[`));
  for (let i = 0; i < 1000; i += 1) {
    said.take(encoder.encode('[0,1,0,2],'.repeat(800)));
    assert.ok(said.end.length < 1000 && said.first.length < 1000);
  }
  assert.equal(said.frames, 1);
});
