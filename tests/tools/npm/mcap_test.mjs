// SPDX-License-Identifier: MIT
// The reader of the MCAP project reads what `camway export` writes: checksums, index, schemas, and the poses
// that `camway sample` prints.
import assert from 'node:assert/strict';
import test from 'node:test';

import {camway, load, plan} from './camway.mjs';

const {McapIndexedReader, McapStreamReader} = load('@mcap/core');
const kFps = 24;
const kSchemas = ['foxglove.FrameTransform', 'foxglove.CameraCalibration', 'foxglove.PosesInFrame',
                  'foxglove.PosesInFrame'];

const planned = plan('office-graze-column');
const bytes = planned.write('shot.mcap', '--format', 'mcap', '--fps', `${kFps}`);
const samples = JSON.parse(camway('sample', planned.response, '--fps', `${kFps}`, '--json'));

async function open() {
  return McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt(bytes.length),
      read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
    },
  });
}

async function messages_of(topic) {
  const reader = await open();
  const list = [];
  for await (const message of reader.readMessages({topics: [topic], validateCrcs: true})) {
    list.push({time_ns: message.logTime, content: JSON.parse(Buffer.from(message.data).toString())});
  }
  return list;
}

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

/// A value is what its JSON schema says, as far as Camway's schemas say it.
function conforms(value, schema, where) {
  if (schema.type === 'object') {
    assert.equal(typeof value, 'object', where);
    for (const [key, member] of Object.entries(schema.properties)) {
      assert.ok(key in value, `${where}.${key} is missing`);
      conforms(value[key], member, `${where}.${key}`);
    }
    assert.deepEqual(Object.keys(value).filter(key => !(key in schema.properties)), [], where);
  } else if (schema.type === 'array') {
    assert.ok(value.length >= (schema.minItems ?? 0) && value.length <= (schema.maxItems ?? Infinity), where);
    value.forEach((each, i) => conforms(each, schema.items, `${where}[${i}]`));
  } else if (schema.type === 'integer') {
    assert.ok(Number.isInteger(value) && value >= schema.minimum && value <= (schema.maximum ?? Infinity), where);
  } else {
    assert.equal(typeof value, schema.type, where);
  }
}

test('the summary tells of all messages', async () => {
  const reader = await open();
  assert.equal(reader.statistics.messageCount, BigInt(samples.length + 3));
  assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
  assert.deepEqual([...reader.channelsById.values()].map(channel => channel.messageEncoding),
                   Array(4).fill('json'));
  assert.deepEqual([...reader.schemasById.values()].map(schema => schema.name), kSchemas);
});

test('all checksums are right', () => {
  const stream = new McapStreamReader({validateCrcs: true});
  stream.append(new Uint8Array(bytes));
  const counts = {};
  for (let record; (record = stream.nextRecord());) counts[record.type] = (counts[record.type] ?? 0) + 1;
  assert.ok(stream.done());
  assert.equal(counts.Message, samples.length + 3);
  assert.deepEqual([counts.Header, counts.DataEnd, counts.Statistics, counts.Footer], [1, 1, 1, 1]);
  assert.equal(counts.SummaryOffset, 4);
});

test('messages are as their schemas say', async () => {
  const reader = await open();
  for (const channel of reader.channelsById.values()) {
    const {name, encoding, data} = reader.schemasById.get(channel.schemaId);
    assert.equal(encoding, 'jsonschema');
    const schema = JSON.parse(Buffer.from(data).toString());
    assert.equal(schema.title, name);
    const messages = await messages_of(channel.topic);
    assert.ok(messages.length > 0, channel.topic);
    for (const {time_ns, content} of messages) {
      conforms(content, schema, channel.topic);
      assert.equal(BigInt(content.timestamp.sec) * 1000000000n + BigInt(content.timestamp.nsec), time_ns);
    }
  }
});

test('the camera moves as the path does', async () => {
  const transforms = await messages_of('/camera/transform');
  assert.equal(transforms.length, samples.length);
  transforms.forEach(({time_ns, content}, i) => {
    assert.equal(time_ns, BigInt(Math.round(samples[i].time * 1e9)));
    assert.equal(content.parent_frame_id, 'world');
    assert.equal(content.child_frame_id, 'camera');
    expect_pose(content.translation, content.rotation, samples[i]);
  });
  const [{content}] = await messages_of('/camera/path');
  assert.equal(content.poses.length, samples.length);
  content.poses.forEach((pose, i) => expect_pose(pose.position, pose.orientation, samples[i]));
});

test('keyframes and lens are those of the answer', async () => {
  const fs = await import('node:fs');
  const answer = JSON.parse(fs.readFileSync(planned.response));
  const [{content: keyframes}] = await messages_of('/camera/keyframes');
  assert.equal(keyframes.poses.length, answer.keyframes.length);
  keyframes.poses.forEach((pose, i) => expect_pose(pose.position, pose.orientation, answer.keyframes[i]));
  const camera = JSON.parse(fs.readFileSync(planned.request)).camera;
  const [{content: lens}] = await messages_of('/camera/calibration');
  const degrees = (size, focal) => 2 * Math.atan(size / 2 / focal) * 180 / Math.PI;
  assert.ok(Math.abs(degrees(lens.width, lens.K[0]) - camera.fov_x_deg) < 1e-9);
  assert.ok(Math.abs(degrees(lens.height, lens.K[4]) - camera.fov_y_deg) < 1e-9);
  assert.equal(lens.frame_id, 'camera');
});

test('damage is found', async () => {
  const intact = bytes[bytes.length - 60];
  bytes[bytes.length - 60] ^= 1;
  await assert.rejects(open(), /summary CRC/);
  bytes[bytes.length - 60] = intact;
  await open();
});
