// Half floats as numbers: a table of all 65536.
const table = new Float32Array(65536);
for (let i = 0; i < 65536; i++) {
  const sign = i & 0x8000 ? -1 : 1, exponent = i >> 10 & 31, mantissa = i & 1023;
  table[i] = sign * (exponent === 0 ? mantissa * 2 ** -24
    : exponent === 31 ? (mantissa ? NaN : Infinity) : (1 + mantissa / 1024) * 2 ** (exponent - 15));
}
export const fromHalf = table;
