// SPDX-License-Identifier: MIT
import type { Segment } from '../src/contract/answer.js';
import type { PlanRequest, Quat, Vec3 } from '../src/contract/request.js';

/** CAMWAY_TEST_SEED tries other random cases. */
const kSeed = Number(process.env['CAMWAY_TEST_SEED'] ?? 20261126);

/** Random numbers that are the same in each run: mulberry32. */
export class Random {
  private state: number;

  constructor(name: string) {
    this.state = [...name].reduce((hash, letter) => Math.imul(hash ^ letter.charCodeAt(0), 0x01000193), kSeed) >>> 0;
    console.log(`${name}: CAMWAY_TEST_SEED=${kSeed}`);
  }

  /** From `least` to `most`. */
  number(least = 0, most = 1): number {
    this.state = (this.state + 0x6d2b79f5) >>> 0;
    let bits = this.state;
    bits = Math.imul(bits ^ (bits >>> 15), bits | 1);
    bits ^= bits + Math.imul(bits ^ (bits >>> 7), bits | 61);
    return least + ((bits ^ (bits >>> 14)) >>> 0) / 2 ** 32 * (most - least);
  }

  /** A whole number below `end`. */
  below(end: number): number {
    return Math.floor(this.number(0, end));
  }

  vector(size = 10): Vec3 {
    return [this.number(-size, size), this.number(-size, size), this.number(-size, size)];
  }

  quaternion(): Quat {
    const q = [0, 0, 0, 0].map(() => this.number(-1, 1)) as Quat;
    const length = Math.hypot(...q);
    return length > 0.1 ? (q.map((x) => x / length) as Quat) : this.quaternion();
  }

  /** Segments one after another. Orientations stay away from zero, as those of Camway do. */
  path(count: number, begin_s = this.number(-5, 5)): Segment[] {
    const path: Segment[] = [];
    let t0 = begin_s;
    for (let i = 0; i < count; ++i) {
      const t1 = t0 + this.number(0.2, 3);
      const q = this.quaternion();
      const near = (): Quat => q.map((x) => x * this.number(0.8, 1.3) + this.number(-0.2, 0.2)) as Quat;
      const position = Array.from({ length: 4 }, () => this.vector());
      const orientation = Array.from({ length: 7 }, near);
      path.push({ t0, t1, position, orientation });
      t0 = t1;
    }
    return path;
  }

  request(keyframes: number, isTimed = this.number() < 0.5): PlanRequest {
    let time = this.number(-10, 10);
    const list = Array.from({ length: keyframes }, () => {
      time += this.number(0.1, 3);
      return { position: this.vector(), orientation: this.quaternion(), ...(isTimed ? { time } : {}) };
    });
    return { scene: '../office.obj', camera: { fov_x_deg: 80, fov_y_deg: 60, near: 0.15 }, keyframes: list };
  }
}
