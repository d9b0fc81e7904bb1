// SPDX-License-Identifier: MIT
// The reader of the MCAP project on files that Camway wrote.
import assert from 'node:assert/strict';

import {load} from './camway.mjs';

const {McapIndexedReader, McapStreamReader} = load('@mcap/core');

/// Opens a file by its summary.
export async function open(bytes) {
  return McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt(bytes.length),
      read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
    },
  });
}

/// The messages of a topic: time_ns and content.
export async function messages_of(bytes, topic) {
  const reader = await open(bytes);
  const list = [];
  for await (const message of reader.readMessages({topics: [topic], validateCrcs: true})) {
    list.push({time_ns: message.logTime, content: JSON.parse(Buffer.from(message.data).toString())});
  }
  return list;
}

/// Reads a file from its begin to its end with all checksums; returns how many records of each type it has.
export function counts_of(bytes) {
  const stream = new McapStreamReader({validateCrcs: true});
  stream.append(new Uint8Array(bytes));
  const counts = {};
  for (let record; (record = stream.nextRecord());) counts[record.type] = (counts[record.type] ?? 0) + 1;
  assert.ok(stream.done());
  return counts;
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
  } else if (schema.type !== undefined) {
    assert.equal(typeof value, schema.type, where);
  }
}

/// Every message is as the schema of its channel says, and has the time that it is logged with.
export async function expect_schemas(bytes) {
  const reader = await open(bytes);
  for (const channel of reader.channelsById.values()) {
    const {name, encoding, data} = reader.schemasById.get(channel.schemaId);
    assert.equal(encoding, 'jsonschema');
    const schema = JSON.parse(Buffer.from(data).toString());
    assert.equal(schema.title, name);
    const messages = await messages_of(bytes, channel.topic);
    assert.ok(messages.length > 0, channel.topic);
    for (const {time_ns, content} of messages) {
      conforms(content, schema, channel.topic);
      assert.equal(BigInt(content.timestamp.sec) * 1000000000n + BigInt(content.timestamp.nsec), time_ns);
    }
  }
}
