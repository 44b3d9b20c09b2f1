// The program in a worker: runs one `pliant check`, whose files are those of the page, and says what it says.

import { ConsoleStdout, PreopenDirectory, SyncOPFSFile, WASI } from '@bjorn3/browser_wasi_shim';

/** Bytes read from a file at a time: reads of a parser are small, and each from a file takes its time. */
const AT_A_TIME = 1 << 22;
const REPORT = 'report.html';

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
        this.bytes = new Uint8Array(this.reader.readAsArrayBuffer(this.file.slice(this.begin, this.begin + AT_A_TIME)));
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
  // The signs of a folder of its own; what the program never calls without threads is not there.
  const instance = new WebAssembly.Instance(module, { wasi_snapshot_preview1: wasi.wasiImport });
  let code;
  try {
    code = wasi.start(instance);
  } catch (error) {
    postMessage({ broken: String(error?.message ?? error), bytes: instance.exports.memory.buffer.byteLength });
    return;
  }
  const report = folder.dir.contents.get(REPORT)?.data;
  postMessage({ code, report, bytes: instance.exports.memory.buffer.byteLength }, report ? [report.buffer] : []);
};
