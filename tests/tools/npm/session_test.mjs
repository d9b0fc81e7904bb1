// SPDX-License-Identifier: MIT
// The reader of the MCAP project reads what `camway session` writes of recorded sessions: requests, paths,
// sentences, and the numbers of the table.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import test from 'node:test';

import {camway, folder, scenes} from './camway.mjs';
import {counts_of, expect_schemas, messages_of, open} from './mcap.mjs';

const kSchemas = ['foxglove.PosesInFrame', 'foxglove.PosesInFrame', 'foxglove.PosesInFrame', 'foxglove.Log',
                  'camway.Answer'];
/// Foxglove's levels of a log.
const kInfo = 2;
const kError = 4;

/// A session as it is written, and the lines of its table.
function written(name) {
  const log = path.join(scenes, 'sessions', `${name}.lcmlog`);
  const file = path.join(folder, `${name}.mcap`);
  const [head, ...lines] = camway('session', log, '--mcap', file, '--csv', '-').trimEnd().split('\r\n');
  const names = head.split(',');
  // Only the last field, the sentence, has commas.
  const rows = lines.map(line => Object.fromEntries(line.split(',').map((field, i) => [names[i], field])));
  return {bytes: fs.readFileSync(file), rows};
}

const office = written('office');
const invalid = written('invalid');

test('summary, checksums and schemas are right', async () => {
  for (const {bytes} of [office, invalid]) {
    const reader = await open(bytes);
    assert.deepEqual([...reader.schemasById.values()].map(schema => schema.name), kSchemas);
    assert.equal(BigInt(counts_of(bytes).Message), reader.statistics.messageCount);
    await expect_schemas(bytes);
  }
});

test('each answer has the numbers of the table', async () => {
  for (const {bytes, rows} of [office, invalid]) {
    const answers = await messages_of(bytes, '/camway/answers');
    assert.equal(answers.length, rows.length);
    answers.forEach(({content}, i) => {
      for (const name of ['client', 'scene', 'status', 'scene_digest']) assert.equal(content[name], rows[i][name]);
      for (const name of ['request_id', 'keyframes', 'segments', 'collisions', 'total_ms']) {
        assert.equal(content[name], Number(rows[i][name]), name);
      }
      assert.equal(content.clearance_m, rows[i].clearance_m === '' ? null : Number(rows[i].clearance_m));
    });
  }
});

test('requests and paths are poses, at the times of the log', async () => {
  const requested = await messages_of(office.bytes, '/camway/requested');
  const keyframes = await messages_of(office.bytes, '/camway/keyframes');
  const paths = await messages_of(office.bytes, '/camway/path');
  assert.equal(requested.length, office.rows.length);
  assert.equal(paths.length, office.rows.length);
  office.rows.forEach((row, i) => {
    assert.equal(requested[i].content.poses.length, Number(row.keyframes));
    assert.equal(keyframes[i].content.poses.length, Number(row.keyframes) + Number(row.inserted_keyframes));
    // A path begins and ends at keyframes of the request, and lasts as the table says.
    const [first] = requested[i].content.poses;
    assert.deepEqual(paths[i].content.poses[0].position, first.position);
    const frames = Number(row.path_duration_s) * 24;
    assert.ok(Math.abs(paths[i].content.poses.length - frames) <= 2, `${paths[i].content.poses.length} ${frames}`);
    assert.ok(requested[i].time_ns < paths[i].time_ns);
    const since_first_s = Number(requested[i].time_ns - requested[0].time_ns) * 1e-9;
    assert.ok(Math.abs(since_first_s - (row.received_s - office.rows[0].received_s)) < 1e-5);
  });
});

test('an answer without a path is a sentence only', async () => {
  const log = await messages_of(invalid.bytes, '/camway/log');
  const without = invalid.rows.filter(row => row.segments === '0').length;
  assert.ok(without > 0);
  assert.equal((await messages_of(invalid.bytes, '/camway/path')).length, invalid.rows.length - without);
  invalid.rows.forEach((row, i) => {
    assert.equal(log[i].content.level, row.status === 'ok' ? kInfo : kError);
    assert.ok(log[i].content.message.startsWith(`${row.client} ${row.request_id}: ${row.status}`));
    assert.equal(log[i].content.name, row.scene);
  });
});
