// SPDX-License-Identifier: MIT
// Refusals that name an option: "request: options.limits.speed_m_per_s: is -2; it must be above 0".

import type { PlanRequest } from '../contract/request.js';
import { optionAt, withOption } from './edits.js';

export interface OptionFault {
  /** The names that lead to the option in `options`. */
  path: readonly string[];
  /** The fault, after the name of the option: "is -2; it must be above 0". */
  words: string;
}

const kRefusal = /(?:^|: )options\.([\w.]+): ([^]*)$/;

/** The option that a refusal names; undefined where it names none. */
export function optionFault(sentence: string): OptionFault | undefined {
  const [, path, words] = kRefusal.exec(sentence) ?? [];
  return path && words ? { path: path.split('.'), words } : undefined;
}

/**
 * The request without the option that a refusal names. Undefined where it names none that the request has: each call
 * leaves fewer options, so asking again and again ends.
 */
export function withoutFault(request: PlanRequest, sentence: string): PlanRequest | undefined {
  const fault = optionFault(sentence);
  if (!fault) return undefined;
  // A member that is missing in an object is mended by leaving out the object.
  for (let path = fault.path; path.length > 0; path = path.slice(0, -1)) {
    if (optionAt(request, path) !== undefined) return withOption(request, path, undefined);
  }
  return undefined;
}
