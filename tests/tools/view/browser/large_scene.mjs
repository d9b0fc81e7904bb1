// SPDX-License-Identifier: MIT
// A scene of as many triangles as asked for: hills in 100 objects, and a shot that is planned into one of them.
import fs from 'node:fs';
import path from 'node:path';

const kTiles = 10;  // along each side
const kSide_m = 40;

function height_m(x, z) {
  return 1.5 * Math.cos(0.35 * x) * Math.cos(0.35 * z) + 0.02 * Math.sin(9 * x) * Math.sin(11 * z);
}

/// Writes NAME.obj and NAME.json into a folder, and returns their names and the number of triangles, which is at least
/// `triangles`.
export function write_large_scene(folder, name, triangles) {
  const cells = Math.ceil(Math.sqrt(triangles / 2) / kTiles);  // of a tile, along each side
  const corners = cells * kTiles + 1;
  const lines = [];
  const place = i => kSide_m * (i / (corners - 1) - 0.5);
  for (let i = 0; i < corners; ++i) {
    for (let j = 0; j < corners; ++j) {
      lines.push(`v ${place(i).toFixed(4)} ${height_m(place(i), place(j)).toFixed(4)} ${place(j).toFixed(4)}`);
    }
  }
  for (let tile = 0; tile < kTiles * kTiles; ++tile) {
    const [row, column] = [Math.floor(tile / kTiles) * cells, (tile % kTiles) * cells];
    lines.push(`o hill_${Math.floor(tile / kTiles)}_${tile % kTiles}`);
    for (let i = row; i < row + cells; ++i) {
      for (let j = column; j < column + cells; ++j) {
        const corner = i * corners + j + 1;
        lines.push(`f ${corner} ${corner + 1} ${corner + corners}`);
        lines.push(`f ${corner + 1} ${corner + corners + 1} ${corner + corners}`);
      }
    }
  }
  const scene = path.join(folder, `${name}.obj`);
  fs.writeFileSync(scene, lines.join('\n'));
  const request = path.join(folder, `${name}.json`);
  fs.writeFileSync(request, JSON.stringify({
    scene: `${name}.obj`,
    camera: {fov_x_deg: 75, fov_y_deg: 55, near: 0.1},
    keyframes: [[-7, 0.6, 1], [7, 0.6, -1]]
                   .map(position => ({position, orientation: [Math.SQRT1_2, 0, -Math.SQRT1_2, 0]})),
  }));
  return {scene, request, triangles: 2 * (cells * kTiles) ** 2};
}
