// The engine in the page itself, as WebAssembly, in a thread of its own: however long a search takes, the page answers.

import { decode, encode } from "./packet.js";

/** @typedef {import("./packet.js").Packet} Packet */

/**
 * What runs in that thread. It takes the bytes of the engine, then messages as bytes, each with its number, and `true`
 * for every frame that was drawn; it posts answers with their numbers, frames with 0, and a text where it has stopped.
 * It stands by itself: nothing outside of it is known there.
 * @param {any} port
 */
function work(port) {
  // milliseconds from frame to frame, and after a message, so that what a hand does is seen at once
  const [every, soon] = [1000 / 60, 8];
  /** @type {any} */
  let parts = null;
  let [before, took, due] = [performance.now(), 0, 0];
  let [drawn, late] = [true, false];
  /** @type {any} */
  let timer = null;
  const output = (/** @type {number} */ length) => new Uint8Array(parts.memory.buffer, parts.output() >>> 0, length).slice();
  /** A call has ended in a trap: the engine is of no use any more. @param {unknown} error */
  const stopped = (error) => {
    const length = parts.failure();
    const at = parts.failed_at() >>> 0;
    const why = length ? new TextDecoder().decode(new Uint8Array(parts.memory.buffer, at, length).slice()) : String(error);
    port.onmessage = null;
    parts = null;
    port.postMessage(why);
  };
  const wait = (/** @type {number} */ until) => {
    clearTimeout(timer);
    timer = setTimeout(tick, Math.max(0, until - performance.now()));
    due = until;
  };
  const tick = () => {
    if (!parts) return;
    // a frame is made when the one before it was drawn
    late = !drawn;
    if (late) return;
    const began = performance.now();
    try {
      const changed = parts.tick(began - before, took);
      before = began;
      took = performance.now() - began;
      if (changed) {
        const frame = output(parts.frame());
        drawn = false;
        port.postMessage([0, frame], [frame.buffer]);
      }
    } catch (error) {
      stopped(error);
      return;
    }
    wait(Math.max(due + every, performance.now()));
  };
  const hear = (/** @type {number} */ number, /** @type {Uint8Array} */ bytes) => {
    const at = parts.input(bytes.length) >>> 0;
    if (!at) {
      port.postMessage([number, `there is no memory for ${bytes.length} bytes`]);
      return;
    }
    try {
      new Uint8Array(parts.memory.buffer, at, bytes.length).set(bytes);
      const answer = output(parts.call());
      port.postMessage([number, answer], [answer.buffer]);
    } catch (error) {
      stopped(error);
      return;
    }
    if (!late) wait(Math.min(due, before + soon));
  };
  port.onmessage = async (/** @type {MessageEvent} */ event) => {
    if (event.data === true) {
      drawn = true;
      if (late) tick();
    } else if (parts) hear(event.data[0], event.data[1]);
    else {
      try {
        parts = (await WebAssembly.instantiate(event.data, {})).instance.exports;
      } catch (error) {
        port.postMessage(String(error));
        return;
      }
      port.postMessage([0, null]);
      wait(performance.now());
    }
  };
}

/** The engine in this page. */
export class Wasm {
  /** @param {any} port */
  constructor(port) {
    this.port = port;
    this.next = 1;
    /** @type {Map<number, {done: (packet: Packet) => void, fail: (error: Error) => void}>} */
    this.open = new Map();
    /** @type {Error | null} */
    this.ended = null;
    /** @type {(frame: Packet) => void} */
    this.onframe = () => {};
    /** @type {(words: string | null) => void} */
    this.onlost = () => {};
    /** @type {() => void} */
    this.began = () => {};
    port.onmessage = (/** @type {MessageEvent} */ event) => this.hear(event.data);
    port.onerror = (/** @type {ErrorEvent} */ event) => this.hear(event.message);
  }

  /**
   * The engine of these bytes.
   * @param {Uint8Array} bytes
   */
  static async of(bytes) {
    let port;
    try {
      const address = URL.createObjectURL(new Blob([`(${work})(self)`], { type: "text/javascript" }));
      port = new Worker(address);
      URL.revokeObjectURL(address);
    } catch {
      // where a page may have no further thread, the engine runs in that of the page
      const channel = new MessageChannel();
      work(channel.port2);
      port = channel.port1;
    }
    const engine = new Wasm(port);
    await new Promise((done, fail) => {
      engine.began = () => done(null);
      engine.onlost = (words) => fail(new Error(words || ""));
      port.postMessage(bytes);
    });
    engine.onlost = () => {};
    return engine;
  }

  /** @param {any} said */
  hear(said) {
    if (typeof said === "string") {
      this.ended = new Error(`The engine has stopped: ${said}. Load the page again.`);
      this.onlost(this.ended.message);
      for (const { fail } of this.open.values()) fail(this.ended);
      this.open.clear();
      return;
    }
    const [number, bytes] = said;
    if (!number) {
      if (bytes) {
        this.onframe(decode(bytes));
        requestAnimationFrame(() => this.port.postMessage(true));
      } else this.began();
      return;
    }
    const asked = this.open.get(number);
    if (!asked) return;
    this.open.delete(number);
    if (typeof bytes === "string") {
      asked.fail(new Error(bytes));
      return;
    }
    const packet = decode(bytes);
    if ("error" in packet.head) asked.fail(new Error(packet.head.error));
    else asked.done(packet);
  }

  /**
   * @param {any} head
   * @param {Uint8Array} [rest]
   * @returns {Promise<Packet>}
   */
  call(head, rest) {
    if (this.ended) return Promise.reject(this.ended);
    const number = this.next++;
    const bytes = encode({ id: number, ...head }, rest);
    return new Promise((done, fail) => {
      this.open.set(number, { done, fail });
      this.port.postMessage([number, bytes], [bytes.buffer]);
    });
  }
}
