// SPDX-License-Identifier: MIT
// The extents of scene and path, in the frame that is drawn, and from where a path is seen well.

import { Box3, Sphere, Vector3 } from 'three';
import type { Vec3 } from '../contract/request.js';
import type { State, Store } from '../model/store.js';
import { upVector } from './frame.js';
import type { Frame, UpAxis } from './frame.js';

const kLeastView_m = 2;
/** A path is seen with that much of what is around it. */
const kAround = 1.3;
const kTilt = { along: 0.15, up: 1, across: 0.75 };
const kNoScene_m = 5;

export interface Bounds {
  min: Vec3;
  max: Vec3;
}

export class Extent {
  private measured: State | undefined;
  private pathBox = new Box3();

  constructor(
    private readonly store: Store,
    private readonly frameNow: () => Frame,
    private readonly upNow: () => UpAxis,
  ) {}

  boxOf({ min, max }: Bounds): Box3 {
    const frame = this.frameNow();
    return new Box3(frame.toLocal(min), frame.toLocal(max));
  }

  placeOf(point: Vec3): Vector3 {
    return this.frameNow().toLocal(point);
  }

  get scene(): Box3 {
    const bounds = this.store.now.scene?.scene.bounds;
    if (bounds) return this.boxOf(bounds);
    const half = new Vector3(kNoScene_m, kNoScene_m, kNoScene_m);
    return new Box3(half.clone().negate(), half);
  }

  get sceneSphere(): Sphere {
    return this.scene.getBoundingSphere(new Sphere());
  }

  /** The box about keyframes and paths; empty if there are none. It is measured once for each of them. */
  private get path(): Box3 {
    const { now } = this.store;
    const { measured } = this;
    const isSame =
      now.request === measured?.request && now.before === measured?.before &&
      now.answer === measured?.answer && now.compared === measured?.compared;
    if (!isSame || !measured || now.scene?.scene.name !== measured.scene?.scene.name) this.measure(now);
    this.measured = now;
    return this.pathBox;
  }

  private measure({ request, before, answer, compared }: State): void {
    const frame = this.frameNow();
    this.pathBox = new Box3();
    for (const { position } of request?.keyframes ?? []) this.pathBox.expandByPoint(frame.toLocal(position));
    for (const path of [before, answer?.segments ?? [], compared?.other.segments ?? []]) {
      for (const { position } of path) for (const point of position) this.pathBox.expandByPoint(frame.toLocal(point));
    }
  }

  get pathSphere(): Sphere | undefined {
    if (this.path.isEmpty()) return undefined;
    const sphere = this.path.getBoundingSphere(new Sphere());
    sphere.radius = Math.max(kAround * sphere.radius, Math.min(kLeastView_m, this.sceneSphere.radius));
    return sphere;
  }

  /** The size by which things that belong to the path are drawn. */
  get pathSize_m(): number {
    return this.pathSphere?.radius ?? 1;
  }

  /** Lowest and highest of the path along `up`; of the scene if there is no path. */
  get pathRange(): [number, number] {
    const box = this.path.isEmpty() ? this.scene : this.path;
    const up = upVector(this.upNow());
    return [up.dot(box.min), up.dot(box.max)];
  }

  /** A sphere about a point, to see what is there. */
  around(point: Vec3): Sphere {
    return new Sphere(this.frameNow().toLocal(point), kLeastView_m);
  }

  /** The direction to the eye: from above, and across the path, so that it runs from side to side. */
  get homeDirection(): Vector3 {
    const up = upVector(this.upNow());
    const across = this.upNow() === 'y' ? new Vector3(0, 0, 1) : new Vector3(0, -1, 0);
    const along = up.clone().cross(across);
    const keyframes = this.store.now.request?.keyframes ?? [];
    const [first, last] = [keyframes[0], keyframes[keyframes.length - 1]];
    if (first && last) {
      const frame = this.frameNow();
      const way = frame.toLocal(last.position).sub(frame.toLocal(first.position));
      way.addScaledVector(up, -way.dot(up));
      const side = way.clone().cross(up);
      if (side.lengthSq() > 1e-4) {
        if (side.dot(across) < 0) side.negate();
        across.copy(side.normalize());
        along.copy(way.normalize());
      }
    }
    return across.multiplyScalar(kTilt.across).addScaledVector(along, kTilt.along).addScaledVector(up, kTilt.up);
  }
}
