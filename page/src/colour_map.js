// Colours from light to dark, so that their order can be seen without hue, on a screen or a print in grey.

import { roundUp } from "./numbers.js";

const stops = [
  [255, 246, 214],
  [252, 205, 133],
  [240, 143, 97],
  [206, 82, 101],
  [145, 42, 116],
  [83, 22, 104],
  [30, 10, 62],
];

// The largest number of bands, but for one at either end.
export const numBands = 10;

/** Returns the colour, [red, green, blue] from 0 to 255, of a value from 0 to 1. */
export function colourOf(t) {
  const place = Math.min(Math.max(t, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(place), stops.length - 2);
  return stops[i].map((from, c) => Math.round(from + (place - i) * (stops[i + 1][c] - from)));
}

/** Returns the colour of one of some bands, from the lightest to the darkest. */
export function colourOfBand(band, count) {
  return colourOf(count === 1 ? 0.35 : (band + 0.2) / (count - 0.6));
}

/**
 * Returns a colour for each value, the darker the larger; by their logarithms where they span more than a factor of ten.
 * Values that are not known are in between.
 */
export function coloursOfValues(values) {
  const known = values.filter(Number.isFinite);
  const scale = Math.min(...known) > 0 && Math.max(...known) > 10 * Math.min(...known) ? Math.log : (value) => value;
  const [least, largest] = [scale(Math.min(...known)), scale(Math.max(...known))];
  return values.map((value) => colourOf(Number.isFinite(value) && largest > least ? 0.1 + (0.8 * (scale(value) - least)) / (largest - least) : 0.35));
}

export const css = ([red, green, blue]) => `rgb(${red}, ${green}, ${blue})`;

/** Returns bands with round ends that hold all values, or null where no value is known. */
export function bandsOf(values) {
  const finite = Array.from(values).filter(Number.isFinite);
  if (finite.length === 0) {
    return null;
  }
  const least = finite.reduce((a, b) => Math.min(a, b));
  const largest = finite.reduce((a, b) => Math.max(a, b));
  // Sizes start at zero; values that hardly differ are no reason for a map of their rounding.
  const lower = least >= 0 && least < 0.5 * largest ? 0 : least;
  const smallest = 1e-6 * Math.max(Math.abs(least), Math.abs(largest));
  const upper = largest - lower > smallest ? largest : lower + (smallest || 1);
  const unit = roundUp((upper - lower) / numBands);
  const first = Math.floor(lower / unit + 1e-9);
  const last = Math.ceil(upper / unit - 1e-9);
  return { lower: first * unit, upper: last * unit, count: last - first };
}
