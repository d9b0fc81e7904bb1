// SPDX-License-Identifier: MIT
// The reader of the MCAP project reads what `camway export` writes: checksums, index, schemas, and the poses
// that `camway sample` prints.
import assert from 'node:assert/strict';
import test from 'node:test';

import {camway, plan} from './camway.mjs';
import {counts_of, expect_schemas, messages_of, open} from './mcap.mjs';

const kFps = 24;
const kSchemas = ['foxglove.FrameTransform', 'foxglove.CameraCalibration', 'foxglove.PosesInFrame',
                  'foxglove.PosesInFrame'];

const planned = plan('office-graze-column');
const bytes = planned.write('shot.mcap', '--format', 'mcap', '--fps', `${kFps}`);
const samples = JSON.parse(camway('sample', planned.response, '--fps', `${kFps}`, '--json'));

/// The camera's own axes from those of its optical frame: a half turn about X, in the order w, x, y, z.
function camera_axes({x, y, z, w}) {
  return [-x, w, z, -y];
}

function expect_pose(position, orientation, sample) {
  [position.x, position.y, position.z].forEach((x, i) => assert.ok(Math.abs(x - sample.position[i]) < 1e-9));
  const q = camera_axes(orientation);
  const sign = q.reduce((sum, x, i) => sum + x * sample.orientation[i], 0) < 0 ? -1 : 1;
  q.forEach((x, i) => assert.ok(Math.abs(sign * x - sample.orientation[i]) < 1e-9));
}

test('the summary tells of all messages', async () => {
  const reader = await open(bytes);
  assert.equal(reader.statistics.messageCount, BigInt(samples.length + 3));
  assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
  assert.deepEqual([...reader.channelsById.values()].map(channel => channel.messageEncoding),
                   Array(4).fill('json'));
  assert.deepEqual([...reader.schemasById.values()].map(schema => schema.name), kSchemas);
});

test('all checksums are right', () => {
  const counts = counts_of(bytes);
  assert.equal(counts.Message, samples.length + 3);
  assert.deepEqual([counts.Header, counts.DataEnd, counts.Statistics, counts.Footer], [1, 1, 1, 1]);
  assert.equal(counts.SummaryOffset, 4);
});

test('messages are as their schemas say', () => expect_schemas(bytes));

test('the camera moves as the path does', async () => {
  const transforms = await messages_of(bytes, '/camera/transform');
  assert.equal(transforms.length, samples.length);
  transforms.forEach(({time_ns, content}, i) => {
    assert.equal(time_ns, BigInt(Math.round(samples[i].time * 1e9)));
    assert.equal(content.parent_frame_id, 'world');
    assert.equal(content.child_frame_id, 'camera');
    expect_pose(content.translation, content.rotation, samples[i]);
  });
  const [{content}] = await messages_of(bytes, '/camera/path');
  assert.equal(content.poses.length, samples.length);
  content.poses.forEach((pose, i) => expect_pose(pose.position, pose.orientation, samples[i]));
});

test('keyframes and lens are those of the answer', async () => {
  const fs = await import('node:fs');
  const answer = JSON.parse(fs.readFileSync(planned.response));
  const [{content: keyframes}] = await messages_of(bytes, '/camera/keyframes');
  assert.equal(keyframes.poses.length, answer.keyframes.length);
  keyframes.poses.forEach((pose, i) => expect_pose(pose.position, pose.orientation, answer.keyframes[i]));
  const camera = JSON.parse(fs.readFileSync(planned.request)).camera;
  const [{content: lens}] = await messages_of(bytes, '/camera/calibration');
  const degrees = (size, focal) => 2 * Math.atan(size / 2 / focal) * 180 / Math.PI;
  assert.ok(Math.abs(degrees(lens.width, lens.K[0]) - camera.fov_x_deg) < 1e-9);
  assert.ok(Math.abs(degrees(lens.height, lens.K[4]) - camera.fov_y_deg) < 1e-9);
  assert.equal(lens.frame_id, 'camera');
});

test('damage is found', async () => {
  const intact = bytes[bytes.length - 60];
  bytes[bytes.length - 60] ^= 1;
  await assert.rejects(open(bytes), /summary CRC/);
  bytes[bytes.length - 60] = intact;
  await open(bytes);
});
