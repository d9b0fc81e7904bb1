// SPDX-License-Identifier: MIT
// The floors of a building, found from its shape: heights where much of the surface lies level and looks up.

import { Matrix4, Vector3 } from 'three';
import type { SceneView } from './scene_view.js';

const kBin_m = 0.1;
const kSteepestFloorCosine = 0.98;
/** A floor has at least that share of the area of the largest. */
const kLeastShare = 0.2;
const kLeastStorey_m = 2;
/** Scenes with more triangles than that are sampled. */
const kMostTriangles = 200_000;

/** Level area by height, in bins; heights are those of the frame that is drawn. */
function levelAreas(scene: SceneView, up: Vector3): Map<number, number> {
  const areas = new Map<number, number>();
  const [a, b, c, normal] = [new Vector3(), new Vector3(), new Vector3(), new Vector3()];
  for (const { shape, mesh } of scene.shapesShown) {
    const positions = shape.geometry.getAttribute('position');
    const indices = shape.geometry.getIndex();
    if (!indices) continue;
    const toFrame: Matrix4 = mesh.matrixWorld;
    const step = 3 * Math.max(1, Math.ceil(indices.count / 3 / kMostTriangles));
    for (let i = 0; i + 2 < indices.count; i += step) {
      a.fromBufferAttribute(positions, indices.getX(i)).applyMatrix4(toFrame);
      b.fromBufferAttribute(positions, indices.getX(i + 1)).applyMatrix4(toFrame);
      c.fromBufferAttribute(positions, indices.getX(i + 2)).applyMatrix4(toFrame);
      normal.copy(b).sub(a).cross(c.clone().sub(a));
      const area = normal.length();
      if (normal.dot(up) < kSteepestFloorCosine * area) continue;
      const bin = Math.round(a.dot(up) / kBin_m);
      areas.set(bin, (areas.get(bin) ?? 0) + (area * step) / 6);
    }
  }
  return areas;
}

/** Heights of the floors along `up`, from below, in the frame that is drawn. */
export function findFloors(scene: SceneView, up: Vector3): number[] {
  const areas = levelAreas(scene, up);
  const largest = Math.max(0, ...areas.values());
  const candidates = [...areas].filter(([, area]) => area >= kLeastShare * largest).sort(([p], [q]) => p - q);
  const floors: { height: number; area: number }[] = [];
  for (const [bin, area] of candidates) {
    const height = bin * kBin_m;
    const last = floors[floors.length - 1];
    if (!last || height - last.height >= kLeastStorey_m) floors.push({ height, area });
    else if (area > 2 * last.area) floors[floors.length - 1] = { height, area }; // a floor, and not what stands below it
  }
  return floors.map(({ height }) => height);
}
