// What the program has said so far: its JSON as it comes, of which little is looked at and nothing is copied again.

/** Text that is searched again with what follows: a mark may begin in it. */
const BEHIND = 64;
const FRAME = /\n\{"frame":\d+,"(until)?/g;
const INSIDE = '"inside":[[';

export class Said {
  constructor() {
    /** All of it, in pieces. */
    this.pieces = [];
    /** Numbers of bodies and of frames that were checked; whether anything lies inside a closed body. */
    [this.bodies, this.frames, this.inside] = [0, 0, false];
    [this.decoder, this.first, this.end] = [new TextDecoder(), '', ''];
  }

  /** Takes the next bytes. A frame is counted once its number has come. */
  take(bytes) {
    this.pieces.push(bytes);
    const piece = this.decoder.decode(bytes, { stream: true });
    this.takeFirst(piece);
    const text = this.end + piece;
    this.inside ||= text.includes(INSIDE);
    let done = Math.max(0, text.length - BEHIND);
    for (const { 1: until, 0: mark, index } of text.matchAll(FRAME)) {
      // What might be `"until"` if more of it had come is left for the next piece.
      if (index + mark.length + 'until'.length > text.length) {
        done = Math.min(done, index);
        break;
      }
      if (!until) this.frames += 1;
      done = Math.max(done, index + mark.length);
    }
    this.end = text.slice(done);
  }

  /** The first line says which bodies there are. */
  takeFirst(piece) {
    if (this.bodies > 0) return;
    const end = piece.indexOf('\n');
    this.first += end < 0 ? piece : piece.slice(0, end);
    if (end >= 0) this.bodies = JSON.parse(`${this.first}]}`).bodies.length;
  }
}
