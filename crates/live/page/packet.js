// Messages as bytes: words as JSON, then numbers as they are.

/**
 * A message: its words, and the bytes that go with them.
 * @typedef {{head: any, rest: Uint8Array}} Packet
 */

/**
 * The bytes of a message.
 * @param {any} head its words
 * @param {Uint8Array} [rest] the bytes that go with them
 * @returns {Uint8Array<ArrayBuffer>}
 */
export function encode(head, rest = new Uint8Array(0)) {
  const words = new TextEncoder().encode(JSON.stringify(head));
  const filled = Math.ceil(words.length / 8) * 8;
  const out = new Uint8Array(8 + filled + rest.length);
  const view = new DataView(out.buffer);
  view.setUint32(0, filled, true);
  view.setUint32(4, rest.length, true);
  out.fill(32, 8, 8 + filled);
  out.set(words, 8);
  out.set(rest, 8 + filled);
  return out;
}

/**
 * The message that these bytes are.
 * @param {Uint8Array} bytes
 * @returns {Packet}
 */
export function decode(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const length = view.getUint32(0, true);
  const more = view.getUint32(4, true);
  if (8 + length + more !== bytes.length) throw new Error("a message must be as long as it says");
  const head = JSON.parse(new TextDecoder().decode(bytes.subarray(8, 8 + length)));
  return { head, rest: bytes.subarray(8 + length) };
}

/**
 * Floats that a message holds: `at` is where they begin and how many there are.
 * @param {Packet} packet
 * @param {[number, number] | null | undefined} at
 * @param {number} [each] floats of one
 * @returns {Float32Array}
 */
export function floats(packet, at, each = 1) {
  if (!at) return new Float32Array(0);
  const bytes = packet.rest.slice(4 * at[0], 4 * (at[0] + each * at[1]));
  return new Float32Array(bytes.buffer, bytes.byteOffset, each * at[1]);
}
