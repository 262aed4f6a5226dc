// The engine in the page itself, as WebAssembly.

import { decode, encode } from "./packet.js";

/** @typedef {import("./packet.js").Packet} Packet */

/** The engine in this page. */
export class Wasm {
  /**
   * @param {any} parts the functions of the engine
   */
  constructor(parts) {
    this.parts = parts;
    this.next = 1;
    this.before = 0;
    this.took = 0;
    /** @type {(frame: Packet) => void} */
    this.onframe = () => {};
    /** @type {(words: string | null) => void} */
    this.onlost = () => {};
    const loop = (/** @type {number} */ now) => {
      this.tick(now);
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  /**
   * The engine of these bytes.
   * @param {BufferSource} bytes
   */
  static async of(bytes) {
    const made = await WebAssembly.instantiate(bytes, {});
    return new Wasm(made.instance.exports);
  }

  /**
   * The bytes that the last function has left, copied.
   * @param {number} length
   */
  output(length) {
    const at = this.parts.output() >>> 0;
    return new Uint8Array(this.parts.memory.buffer, at, length).slice();
  }

  /**
   * A call has ended in a trap: the engine is of no use any more.
   * @param {unknown} error
   */
  stopped(error) {
    const length = this.parts.failure();
    const why = length
      ? new TextDecoder().decode(new Uint8Array(this.parts.memory.buffer, this.parts.failed_at() >>> 0, length))
      : String(error);
    this.onlost(`The engine has stopped: ${why}. Load the page again.`);
    this.tick = () => {};
  }

  /** @param {number} now */
  tick(now) {
    const passed = this.before ? now - this.before : 0;
    this.before = now;
    const began = performance.now();
    try {
      const changed = this.parts.tick(passed, this.took);
      this.took = performance.now() - began;
      if (changed) this.onframe(decode(this.output(this.parts.frame())));
    } catch (error) {
      this.stopped(error);
    }
  }

  /**
   * @param {any} head
   * @param {Uint8Array} [rest]
   * @returns {Promise<Packet>}
   */
  async call(head, rest) {
    const bytes = encode({ id: this.next++, ...head }, rest);
    const at = this.parts.input(bytes.length) >>> 0;
    if (!at) throw new Error(`there is no memory for ${bytes.length} bytes`);
    new Uint8Array(this.parts.memory.buffer, at, bytes.length).set(bytes);
    let packet;
    try {
      packet = decode(this.output(this.parts.call()));
    } catch (error) {
      this.stopped(error);
      throw error;
    }
    if ("error" in packet.head) throw new Error(packet.head.error);
    return packet;
  }
}
