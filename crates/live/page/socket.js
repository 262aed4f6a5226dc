// The engine behind a socket: that of the program which serves this page.

import { decode, encode } from "./packet.js";

/**
 * What a page needs of an engine, wherever it runs.
 * @typedef {object} Engine
 * @property {(head: any, rest?: Uint8Array) => Promise<import("./packet.js").Packet>} call carry out a message
 * @property {(frame: import("./packet.js").Packet) => void} onframe told of every frame
 * @property {(words: string | null) => void} onlost told when the engine is out of reach, and when it is back
 */

/** Milliseconds until a lost connection is tried again, at first and at most. */
const AGAIN = [250, 4000];

/** The engine at the other end of a socket. */
export class Socket {
  /** @param {string} url */
  constructor(url) {
    this.url = url;
    this.me = Math.random().toString(36).slice(2) + Date.now().toString(36);
    this.next = 1;
    /** @type {Map<number, {bytes: Uint8Array<ArrayBuffer>, done: (p: import("./packet.js").Packet) => void, fail: (e: Error) => void}>} */
    this.open = new Map();
    this.wait = AGAIN[0];
    /** @type {WebSocket | null} */
    this.socket = null;
    /** @type {(frame: import("./packet.js").Packet) => void} */
    this.onframe = () => {};
    /** @type {(words: string | null) => void} */
    this.onlost = () => {};
    this.connect();
  }

  connect() {
    const socket = new WebSocket(`${this.url}&me=${this.me}`);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.wait = AGAIN[0];
      // what was not answered is said again, in order; the server carries nothing out twice
      for (const { bytes } of this.open.values()) socket.send(bytes);
      this.onlost(null);
    };
    socket.onmessage = (event) => {
      const packet = decode(new Uint8Array(event.data));
      if ("kind" in packet.head) {
        this.onframe(packet);
        return;
      }
      const asked = this.open.get(packet.head.id);
      if (!asked) return;
      this.open.delete(packet.head.id);
      if ("error" in packet.head) asked.fail(new Error(packet.head.error));
      else asked.done(packet);
    };
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.onlost("The connection to the program is lost. Trying again …");
      setTimeout(() => this.connect(), this.wait);
      this.wait = Math.min(2 * this.wait, AGAIN[1]);
    };
  }

  /**
   * @param {any} head
   * @param {Uint8Array} [rest]
   * @returns {Promise<import("./packet.js").Packet>}
   */
  call(head, rest) {
    const id = this.next++;
    const bytes = encode({ id, ...head }, rest);
    return new Promise((done, fail) => {
      this.open.set(id, { bytes, done, fail });
      if (this.socket && this.socket.readyState === WebSocket.OPEN) this.socket.send(bytes);
    });
  }
}
