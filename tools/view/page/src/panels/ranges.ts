// SPDX-License-Identifier: MIT
//
// Ranges of options as the field table of Camway words them: "from 0 to 1e+09", "above 0 and at most 1",
// "between 0 and 180°", "at least 1", "at least 0.1 and finite".

export interface Range {
  least: number;
  most: number;
  excludesLeast: boolean;
  excludesMost: boolean;
}

const kNumber = '(-?[0-9.]+(?:e[+-]?[0-9]+)?)';
const kClosed = new RegExp(`^(?:from|between) ${kNumber} (?:to|and) ${kNumber}`);
const kLeast = new RegExp(`\\b(above|at least) ${kNumber}`);
const kMost = new RegExp(`\\b(below|at most) ${kNumber}`);

/** Reads a range. Undefined where the words are others: then Camway alone checks the value. */
export function rangeOf(words: string | undefined): Range | undefined {
  if (!words) return undefined;
  const closed = kClosed.exec(words);
  if (closed) return { least: Number(closed[1]), most: Number(closed[2]), excludesLeast: false, excludesMost: false };
  const least = kLeast.exec(words);
  const most = kMost.exec(words);
  if (!least && !most) return undefined;
  return {
    least: least ? Number(least[2]) : -Infinity,
    most: most ? Number(most[2]) : Infinity,
    excludesLeast: least?.[1] === 'above',
    excludesMost: most?.[1] === 'below',
  };
}

/** Whether a value is finite and in the range, if there is one. */
export function isWithin(range: Range | undefined, value: number): boolean {
  if (!Number.isFinite(value)) return false;
  if (!range) return true;
  const isHigh = range.excludesLeast ? value > range.least : value >= range.least;
  const isLow = range.excludesMost ? value < range.most : value <= range.most;
  return isHigh && isLow;
}

/** What a number field takes, as a sentence for one that has something else. */
export function wrongText(range: Range | undefined, isWhole = false): string {
  const noun = isWhole ? 'a whole number' : 'a number';
  const parts: string[] = [];
  if (range && range.least > -Infinity) parts.push(`${range.excludesLeast ? 'above' : 'at least'} ${range.least}`);
  const most = Math.min(range?.most ?? Infinity, isWhole ? Number.MAX_SAFE_INTEGER : Infinity);
  if (most < Infinity) parts.push(`${range?.excludesMost ? 'below' : 'at most'} ${most}`);
  return `This must be ${[noun, parts.join(' and ')].filter((words) => words !== '').join(', ')}.`;
}
