// sha256.js: SHA-256 (FIPS 180-4) of bytes, as 64 hexadecimal digits. Browsers have their own only in pages by https.

// The first 32 bits of the fractional parts of roots: square roots of the first 8 primes, cube roots of the first 64.
const primes = [];
for (let n = 2; primes.length < 64; n++) if (primes.every((p) => n % p !== 0)) primes.push(n);
const fraction = (root) => Math.floor((root % 1) * 2 ** 32);
const first = Int32Array.from(primes.slice(0, 8), (p) => fraction(Math.sqrt(p)));
const constants = Int32Array.from(primes, (p) => fraction(Math.cbrt(p)));

const turn = (x, n) => (x >>> n) | (x << (32 - n));
const words = new Int32Array(64);

function addBlock(state, view, at) {
  for (let i = 0; i < 16; i++) words[i] = view.getInt32(at + 4 * i);
  for (let i = 16; i < 64; i++) {
    const [x, y] = [words[i - 15], words[i - 2]];
    words[i] = words[i - 16] + words[i - 7] + (turn(x, 7) ^ turn(x, 18) ^ (x >>> 3)) + (turn(y, 17) ^ turn(y, 19) ^ (y >>> 10));
  }
  let [a, b, c, d, e, f, g, h] = state;
  for (let i = 0; i < 64; i++) {
    const one = (h + (turn(e, 6) ^ turn(e, 11) ^ turn(e, 25)) + ((e & f) ^ (~e & g)) + constants[i] + words[i]) | 0;
    const two = (turn(a, 2) ^ turn(a, 13) ^ turn(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
    [h, g, f, e, d, c, b, a] = [g, f, e, (d + one) | 0, c, b, a, (one + two) | 0];
  }
  [a, b, c, d, e, f, g, h].forEach((value, i) => (state[i] += value));
}

export function sha256(bytes) {
  const state = first.slice();
  const whole = bytes.length - (bytes.length % 64);
  const view = new DataView(bytes.buffer, bytes.byteOffset, whole);
  for (let at = 0; at < whole; at += 64) addBlock(state, view, at);
  const end = new Uint8Array(bytes.length - whole < 56 ? 64 : 128); // what is left, a bit, zeros, the length in bits
  end.set(bytes.subarray(whole));
  end[bytes.length - whole] = 0x80;
  const rest = new DataView(end.buffer);
  rest.setBigUint64(end.length - 8, BigInt(bytes.length) * 8n);
  for (let at = 0; at < end.length; at += 64) addBlock(state, rest, at);
  return Array.from(state, (value) => (value >>> 0).toString(16).padStart(8, '0')).join('');
}
