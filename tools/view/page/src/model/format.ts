// SPDX-License-Identifier: MIT
//
// Numbers as people read them. Units are separated by a space, but not degrees.

/** Times from here on count from some epoch; they are shown from the begin of the path. */
const kEpoch_s = 1e5;

/** A number with three significant digits, without an exponent where people can do without. */
export function numberText(value: number, digits = 3): string {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  if (size === 0) return '0';
  if (size >= 1e6 || size < 1e-5) return value.toExponential(digits - 1).replace('e+', 'e').replace('-', '−');
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return value.toFixed(Math.min(decimals, 8)).replace('-', '−');
}

/** A proved lower bound: rounded down, as a larger number would not be proved. Requires `value` to be 0 or more. */
export function lowerBoundText(value: number, digits = 3): string {
  if (!(value > 0) || !Number.isFinite(value)) return numberText(value, digits);
  const step = 10 ** (Math.floor(Math.log10(value)) - digits + 1);
  const floored = Number((Math.floor(value / step) * step).toPrecision(digits));
  return numberText(floored > value ? floored - step : floored, digits);
}

export function withUnit(value: number, unit: string, digits = 3): string {
  return `${numberText(value, digits)}${unit.startsWith('°') || unit === '' ? '' : ' '}${unit}`;
}

/** An instant of a path that begins at `begin_s`, without the unit. */
export function timeText(time_s: number, begin_s = 0, decimals = 2): string {
  return isEpoch(begin_s) ? `+${(time_s - begin_s).toFixed(decimals)}` : time_s.toFixed(decimals);
}

/** An instant of a path and the end of it, on the same clock, in seconds. */
export function positionText(time_s: number, begin_s: number, end_s: number): string {
  return `${timeText(time_s, begin_s)} / ${timeText(end_s, begin_s)} s`;
}

/** Whether times of a path that begins then are shown from its begin. */
export function isEpoch(begin_s: number): boolean {
  return Math.abs(begin_s) > kEpoch_s;
}

/** A duration in milliseconds, in the unit that reads best. */
export function durationText(milliseconds: number): string {
  return milliseconds >= 1000 ? `${numberText(milliseconds / 1000)} s` : `${numberText(milliseconds, milliseconds < 1 ? 2 : 3)} ms`;
}

/** `count` with the noun, which gets an s unless there is one. */
export function counted(count: number, noun: string, plural = `${noun}s`): string {
  return `${count.toLocaleString('en')} ${count === 1 ? noun : plural}`;
}
