// Arrays of numbers that the page carries as base64, in little-endian order.

function bytesOf(text) {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < characters.length; ++i) {
    bytes[i] = characters.charCodeAt(i);
  }
  return bytes.buffer;
}

/** Returns null for a field that is not there. */
export const floats = (text) => (text === null || text === undefined ? null : new Float32Array(bytesOf(text)));
export const integers = (text) => new Uint32Array(bytesOf(text));
export const bytes = (text) => new Uint8Array(bytesOf(text));

/** Returns the length of each vector of three numbers. */
export function lengths(vectors) {
  return Float32Array.from({ length: vectors.length / 3 }, (_, i) =>
    Math.hypot(vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2]),
  );
}
