// SPDX-License-Identifier: MIT
// The part of Node that the tests use: its types are a package that the page needs for nothing else.

declare module 'node:test' {
  interface Options {
    skip?: string | false;
  }
  export function test(name: string, body: () => void): void;
  export function test(name: string, options: Options, body: () => void): void;
}

declare module 'node:assert/strict' {
  interface Assert {
    (value: unknown, message?: string): asserts value;
    equal(actual: unknown, expected: unknown, message?: string): void;
    notEqual(actual: unknown, expected: unknown, message?: string): void;
    deepEqual(actual: unknown, expected: unknown, message?: string): void;
    match(text: string, pattern: RegExp, message?: string): void;
    ok(value: unknown, message?: string): asserts value;
  }
  const assert: Assert;
  export default assert;
}

declare module 'node:fs' {
  export function readFileSync(path: string, encoding: 'utf8'): string;
  export function readdirSync(path: string, options?: { recursive: boolean }): string[];
  export function existsSync(path: string): boolean;
  export function mkdtempSync(prefix: string): string;
  export function writeFileSync(path: string, text: string): void;
  export function rmSync(path: string, options: { recursive: boolean }): void;
}

declare module 'node:os' {
  export function tmpdir(): string;
}

declare module 'node:child_process' {
  export function spawnSync(program: string, args: readonly string[], options: object): { status: number | null; stderr: string };
}

declare const process: { env: Record<string, string | undefined> };
