// The program in a worker: runs one `pliant check`, whose files are those of the page, and says what it says.

import { ConsoleStdout, PreopenDirectory, SyncOPFSFile, WASI } from '@bjorn3/browser_wasi_shim';

/** Bytes read from a file at a time: reads of a parser are small, and each from a file takes its time. */
const AT_A_TIME = 1 << 22;
const REPORT = 'report.html';

/** Files of which a piece is held at most: a sequence may have thousands. */
const MOST_HELD = 8;
const held = [];

/** A file that has changed since it was dropped, or that the browser cannot read. */
class Unreadable extends Error {}

/** A file that was dropped, as the shim reads files: in pieces, when the program asks for them, never as a whole. */
class Dropped {
  constructor(file) {
    this.file = file;
    this.reader = new FileReaderSync();
    [this.begin, this.bytes] = [0, new Uint8Array()];
  }

  getSize() {
    return this.file.size;
  }

  read(buffer, { at }) {
    let filled = 0;
    while (filled < buffer.length && at + filled < this.file.size) {
      const place = at + filled - this.begin;
      if (place < 0 || place >= this.bytes.length) {
        this.begin = at + filled;
        try {
          this.bytes = new Uint8Array(this.reader.readAsArrayBuffer(this.file.slice(this.begin, this.begin + AT_A_TIME)));
        } catch {
          throw new Unreadable(this.file.name);
        }
        if (!held.includes(this)) held.push(this);
        if (held.length > MOST_HELD) held.shift().bytes = new Uint8Array();
        if (this.bytes.length === 0) break;
        continue;
      }
      const some = this.bytes.subarray(place, place + buffer.length - filled);
      buffer.set(some, filled);
      filled += some.length;
    }
    return filled;
  }
}

onmessage = ({ data: { module, words, files } }) => {
  const folder = new PreopenDirectory('.', new Map(files.map((file) => [file.name, new SyncOPFSFile(new Dropped(file), { readonly: true })])));
  const output = new ConsoleStdout((bytes) => postMessage({ output: bytes.slice() }));
  const notes = ConsoleStdout.lineBuffered((note) => postMessage({ note }));
  const wasi = new WASI(['pliant', 'check', ...words, '--format', 'json', '--report', REPORT], [], [new ConsoleStdout(() => {}), output, notes, folder]);
  // The shim counts the letters of an argument where it should count its bytes.
  wasi.wasiImport.args_sizes_get = (count, size) => {
    const view = new DataView(instance.exports.memory.buffer);
    view.setUint32(count, wasi.args.length, true);
    view.setUint32(size, wasi.args.reduce((sum, word) => sum + new TextEncoder().encode(word).length + 1, 0), true);
    return 0;
  };
  const instance = new WebAssembly.Instance(module, { wasi_snapshot_preview1: wasi.wasiImport });
  let code;
  try {
    code = wasi.start(instance);
  } catch (error) {
    const bytes = instance.exports.memory.buffer.byteLength;
    postMessage(error instanceof Unreadable ? { unreadable: error.message } : { broken: String(error?.message ?? error), bytes });
    return;
  }
  const report = folder.dir.contents.get(REPORT)?.data;
  postMessage({ code, report }, report ? [report.buffer] : []);
};
