// What is packed by LZMA, unpacked: the engine that lies in a page of one file. (I. Pavlov's format of 1998, ".lzma".)

/** Bits of a probability, and how fast it is learnt. */
const [BITS, RATE] = [11, 5];

/** A number that arithmetic coding has: reads bits by their probabilities. */
class Reader {
  /**
   * @param {Uint8Array} bytes
   * @param {number} at
   */
  constructor(bytes, at) {
    this.bytes = bytes;
    this.at = at + 1;
    this.range = 0xffffffff;
    this.code = 0;
    for (let i = 0; i < 4; i++) this.code = ((this.code << 8) | bytes[this.at++]) >>> 0;
  }

  narrow() {
    if (this.range < 0x1000000) {
      this.range = (this.range << 8) >>> 0;
      this.code = ((this.code << 8) | this.bytes[this.at++]) >>> 0;
    }
  }

  /**
   * @param {Uint16Array} odds
   * @param {number} i
   */
  bit(odds, i) {
    const odd = odds[i];
    const bound = (this.range >>> BITS) * odd;
    let bit = 0;
    if (this.code < bound) {
      this.range = bound;
      odds[i] = odd + (((1 << BITS) - odd) >>> RATE);
    } else {
      this.range -= bound;
      this.code -= bound;
      odds[i] = odd - (odd >>> RATE);
      bit = 1;
    }
    this.narrow();
    return bit;
  }

  /** So many bits that are as often 0 as 1. @param {number} count */
  plain(count) {
    let value = 0;
    for (let i = 0; i < count; i++) {
      this.range >>>= 1;
      const bit = this.code >= this.range ? 1 : 0;
      if (bit) this.code -= this.range;
      value = value * 2 + bit;
      this.narrow();
    }
    return value;
  }

  /**
   * A number of so many bits, the highest first.
   * @param {Uint16Array} odds
   * @param {number} from
   * @param {number} count
   */
  tree(odds, from, count) {
    let m = 1;
    for (let i = 0; i < count; i++) m = (m << 1) | this.bit(odds, from + m);
    return m - (1 << count);
  }

  /**
   * The same, the lowest first.
   * @param {Uint16Array} odds
   * @param {number} from
   * @param {number} count
   */
  reverse(odds, from, count) {
    let [m, value] = [1, 0];
    for (let i = 0; i < count; i++) {
      const bit = this.bit(odds, from + m);
      m = (m << 1) | bit;
      value |= bit << i;
    }
    return value;
  }
}

/** @param {number} count */
const fair = (count) => new Uint16Array(count).fill(1 << (BITS - 1));

/** How long a match is. */
class Length {
  constructor() {
    this.choice = fair(2);
    this.low = fair(16 << 3);
    this.middle = fair(16 << 3);
    this.high = fair(256);
  }

  /**
   * @param {Reader} reader
   * @param {number} place
   */
  read(reader, place) {
    if (!reader.bit(this.choice, 0)) return 2 + reader.tree(this.low, place << 3, 3);
    if (!reader.bit(this.choice, 1)) return 10 + reader.tree(this.middle, place << 3, 3);
    return 18 + reader.tree(this.high, 0, 8);
  }
}

/**
 * The bytes that were packed.
 * @param {Uint8Array} packed
 * @returns {Uint8Array<ArrayBuffer>}
 */
export function unpack(packed) {
  let first = packed[0];
  const lc = first % 9;
  first = (first - lc) / 9;
  const lp = first % 5;
  const pb = (first - lp) / 5;
  const view = new DataView(packed.buffer, packed.byteOffset);
  const size = view.getUint32(5, true) + 2 ** 32 * view.getUint32(9, true);
  if (!(size < 2 ** 28)) throw new Error(`what is packed must say that it has less than 2^28 bytes, got ${size}`);
  const out = new Uint8Array(size);
  const reader = new Reader(packed, 13);
  const literals = fair(0x300 << (lc + lp));
  const [isMatch, isRep, isRep0, isRep1, isRep2, isShort] = [fair(192), fair(12), fair(12), fair(12), fair(12), fair(192)];
  const [slots, near, align] = [fair(256), fair(128), fair(16)];
  const [lengths, repeated] = [new Length(), new Length()];
  let [state, done] = [0, 0];
  let reps = [0, 0, 0, 0];
  while (done < size) {
    const place = done & ((1 << pb) - 1);
    if (!reader.bit(isMatch, (state << 4) + place)) {
      const before = done ? out[done - 1] : 0;
      const context = ((done & ((1 << lp) - 1)) << lc) + (before >> (8 - lc));
      const from = 0x300 * context;
      let m = 1;
      if (state >= 7) {
        let match = out[done - reps[0] - 1];
        while (m < 256) {
          const high = (match >> 7) & 1;
          match <<= 1;
          const bit = reader.bit(literals, from + ((1 + high) << 8) + m);
          m = (m << 1) | bit;
          if (high !== bit) break;
        }
      }
      while (m < 256) m = (m << 1) | reader.bit(literals, from + m);
      out[done++] = m & 255;
      state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
      continue;
    }
    let length;
    if (!reader.bit(isRep, state)) {
      reps = [0, reps[0], reps[1], reps[2]];
      length = lengths.read(reader, place);
      state = state < 7 ? 7 : 10;
      const slot = reader.tree(slots, Math.min(length - 2, 3) << 6, 6);
      let distance = slot;
      if (slot >= 4) {
        const bits = (slot >> 1) - 1;
        distance = (2 | (slot & 1)) * 2 ** bits;
        if (slot < 14) distance += reader.reverse(near, distance - slot, bits);
        else distance += reader.plain(bits - 4) * 16 + reader.reverse(align, 0, 4);
      }
      // the end, where it is marked
      if (distance >= 0xffffffff) break;
      reps[0] = distance;
    } else {
      if (!reader.bit(isRep0, state)) {
        if (!reader.bit(isShort, (state << 4) + place)) {
          state = state < 7 ? 9 : 11;
          out[done] = out[done - reps[0] - 1];
          done++;
          continue;
        }
      } else if (!reader.bit(isRep1, state)) reps = [reps[1], reps[0], reps[2], reps[3]];
      else if (!reader.bit(isRep2, state)) reps = [reps[2], reps[0], reps[1], reps[3]];
      else reps = [reps[3], reps[0], reps[1], reps[2]];
      length = repeated.read(reader, place);
      state = state < 7 ? 8 : 11;
    }
    const from = done - reps[0] - 1;
    if (from < 0 || done + length > size) throw new Error("what is packed is broken");
    for (let i = 0; i < length; i++) out[done + i] = out[from + i];
    done += length;
  }
  return out;
}
