// Numbers as text, by the rules of core/text/numbers.cc, so that the page and the command line show the same digits.

const smallestPlain = 1e-4;
const largestPlain = 1e7;
const mostDigits = 10;
const largestRatio = 10;

// The power of ten of the first digit of a number that is not zero.
function placeOf(value) {
  return Number(Math.abs(value).toExponential(15).split("e")[1]);
}

// Rounds to the digit of this power of ten and writes no exponent.
function plainText(value, place) {
  const unit = 10 ** place;
  if (Math.abs(value) < unit / 2) {
    return (0).toFixed(Math.max(-place, 0));
  }
  return place > 0 ? (Math.round(value / unit) * unit).toFixed(0) : value.toFixed(-place);
}

const withoutZeros = (text) => (text.includes(".") ? text.replace(/\.?0+$/, "") : text);

// Writes as %g of C does.
function generalText(value, digits) {
  if (value === 0) {
    return "0";
  }
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  const power = Number(exponent);
  if (power >= -4 && power < digits) {
    return withoutZeros(value.toFixed(digits - 1 - power));
  }
  const sign = power < 0 ? "-" : "+";
  return `${withoutZeros(mantissa)}e${sign}${String(Math.abs(power)).padStart(2, "0")}`;
}

/** Writes so many significant digits, with an exponent only below 1e-4 and from 1e7 on. */
export function numberText(value, digits = 6) {
  const size = Math.abs(value);
  if (size >= 1 && size < largestPlain && placeOf(value) >= digits - 1) {
    return plainText(value, placeOf(value) - digits + 1);
  }
  return generalText(value, digits);
}

export const twoDigits = (value) => numberText(value, 2);

/** Writes a value and its standard deviation, which has two digits, to the same place. */
export function valueWithError(value, error) {
  const larger = Math.max(Math.abs(value), error);
  if (!(error > 0) || larger < smallestPlain || !(larger < largestPlain)) {
    let digits = 6;
    if (error > 0 && value !== 0) {
      digits = 2 + Math.ceil(Math.log10(Math.abs(value) / error));
      digits = Math.min(Math.max(digits, 3), mostDigits);
    }
    return `${numberText(value, digits)} ± ${numberText(error, 2)}`;
  }
  let place = placeOf(error) - 1;
  place += Math.round(error / 10 ** place) > 99 ? 1 : 0;
  const least = placeOf(larger) + 1 - mostDigits;
  const errorText = place >= least ? plainText(error, place) : numberText(error, 2);
  return `${plainText(value, Math.max(place, least))} ± ${errorText}`;
}

/** Writes a share, or an error relative to a value. */
export function percent(ratio) {
  return Math.abs(ratio) > largestRatio ? "more than ten times its value" : `${twoDigits(100 * ratio)} %`;
}

/** Writes a share of something else. */
export function percentOf(ratio, whole) {
  return Math.abs(ratio) > largestRatio ? `more than ten times ${whole}` : `${percent(ratio)} of ${whole}`;
}

/** Writes "1 node", "3 nodes". */
export function counted(count, noun) {
  return `${count} ${noun}${count === 1 ? "" : "s"}`;
}

/** Writes the ends of an interval to the place of the third digit of its width. */
export function intervalText([lower, upper]) {
  const largest = Math.max(Math.abs(lower), Math.abs(upper));
  if (!(upper > lower) || largest < smallestPlain || largest >= largestPlain) {
    return `${numberText(lower, 4)} to ${numberText(upper, 4)}`;
  }
  const place = Math.max(placeOf(upper - lower) - 2, placeOf(largest) + 1 - mostDigits);
  return `${plainText(lower, place)} to ${plainText(upper, place)}`;
}

/** Returns 1, 2 or 5 times a power of ten that is no less than a positive value. */
export function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].find((factor) => factor * power >= value * (1 - 1e-9)) * power;
}

/** Returns about `count` round numbers between two ends, which are no more than they contain. */
export function ticks(lower, upper, count) {
  const step = (upper - lower) / count;
  if (!(step > 0)) {
    return [lower];
  }
  const unit = roundUp(step);
  const values = [];
  for (let i = Math.ceil(lower / unit - 1e-9); i * unit <= upper + 1e-9 * unit; ++i) {
    values.push(i * unit + 0);
  }
  return values;
}
