// SPDX-License-Identifier: MIT
// Pictures as Chromium writes them (PNG with 8 bits of red, green, blue and maybe alpha), and small ones with a palette.
import assert from 'node:assert/strict';
import zlib from 'node:zlib';

const kSignature = Buffer.from('\x89PNG\r\n\x1a\n', 'latin1');
const kMostColours = 256;

function paeth(left, above, corner) {
  const [l, a, c] = [left, above, corner].map(x => Math.abs(left + above - corner - x));
  return l <= a && l <= c ? left : a <= c ? above : corner;
}

/// Takes the filters of the rows off. `data` has a byte before each row, which names its filter.
function unfiltered(data, row_bytes, bytes_per_pixel) {
  const rows = Buffer.alloc(data.length / (row_bytes + 1) * row_bytes);
  for (let from = 0, to = 0; from < data.length; from += row_bytes + 1, to += row_bytes) {
    const filter = data[from];
    for (let i = 0; i < row_bytes; ++i) {
      const left = i < bytes_per_pixel ? 0 : rows[to + i - bytes_per_pixel];
      const above = to === 0 ? 0 : rows[to + i - row_bytes];
      const corner = i < bytes_per_pixel || to === 0 ? 0 : rows[to + i - row_bytes - bytes_per_pixel];
      const guess = [0, left, above, (left + above) >> 1, filter === 4 ? paeth(left, above, corner) : 0][filter];
      rows[to + i] = data[from + 1 + i] + guess;
    }
  }
  return rows;
}

/// Reads a picture: width, height, and the colour of the pixel (x, y) as 0xrrggbb.
export function read_png(bytes) {
  assert.ok(bytes.subarray(0, 8).equals(kSignature));
  const chunks = [];
  for (let at = 8; at < bytes.length;) {
    const size = bytes.readUInt32BE(at);
    chunks.push({type: bytes.toString('latin1', at + 4, at + 8), data: bytes.subarray(at + 8, at + 8 + size)});
    at += 12 + size;
  }
  const head = chunks[0].data;
  const [width, height] = [head.readUInt32BE(0), head.readUInt32BE(4)];
  assert.equal(head[8], 8, 'bits of a sample');
  const samples = {2: 3, 6: 4}[head[9]];
  assert.ok(samples, 'a picture in colours');
  const packed = Buffer.concat(chunks.filter(({type}) => type === 'IDAT').map(({data}) => data));
  const rows = unfiltered(zlib.inflateSync(packed), width * samples, samples);
  return {width, height, pixel: (x, y) => rows.readUIntBE((y * width + x) * samples, 3)};
}

/// Counts the pixels whose red, green and blue are each within `reach` of `colour`.
export function count_of(picture, colour, reach = 24) {
  const near = (a, b, shift) => Math.abs(((a >> shift) & 255) - ((b >> shift) & 255)) <= reach;
  let count = 0;
  for (let y = 0; y < picture.height; ++y) {
    for (let x = 0; x < picture.width; ++x) {
      const found = picture.pixel(x, y);
      if (near(found, colour, 16) && near(found, colour, 8) && near(found, colour, 0)) ++count;
    }
  }
  return count;
}

/// Counts the pixels that differ between two pictures of the same size.
export function count_of_changes(one, other) {
  assert.deepEqual([one.width, one.height], [other.width, other.height]);
  let count = 0;
  for (let y = 0; y < one.height; ++y) {
    for (let x = 0; x < one.width; ++x) if (one.pixel(x, y) !== other.pixel(x, y)) ++count;
  }
  return count;
}

/// A palette by median cut: the box of colours with the most pixels along its longest edge is cut in two.
function palette_of(counts) {
  const box_of = colours => {
    const ends = [16, 8, 0].map(shift => {
      const values = colours.map(colour => (colour >> shift) & 255);
      return {shift, size: values.reduce((a, b) => Math.max(a, b)) - values.reduce((a, b) => Math.min(a, b))};
    });
    const longest = ends.reduce((a, b) => (b.size > a.size ? b : a));
    const pixels = colours.reduce((sum, colour) => sum + counts.get(colour), 0);
    return {colours, ...longest, weight: longest.size * Math.sqrt(pixels)};
  };
  const boxes = [box_of([...counts.keys()])];
  while (boxes.length < kMostColours) {
    const widest = boxes.reduce((a, b) => (b.weight > a.weight ? b : a));
    if (widest.size === 0) break;
    const value = colour => (colour >> widest.shift) & 255;
    const sorted = widest.colours.sort((a, b) => value(a) - value(b) || a - b);
    const half = sorted.reduce((sum, colour) => sum + counts.get(colour), 0) / 2;
    let cut = 1;
    for (let sum = counts.get(sorted[0]); cut < sorted.length - 1 && sum < half; ++cut) sum += counts.get(sorted[cut]);
    boxes.splice(boxes.indexOf(widest), 1, box_of(sorted.slice(0, cut)), box_of(sorted.slice(cut)));
  }
  return boxes.map(({colours}) => {
    const total = colours.reduce((sum, colour) => sum + counts.get(colour), 0);
    const mean = shift => colours.reduce((sum, colour) => sum + ((colour >> shift) & 255) * counts.get(colour), 0) / total;
    return {colours, colour: Buffer.from([16, 8, 0].map(shift => Math.round(mean(shift))))};
  });
}

/// Writes a picture with a palette of at most 256 colours. Its bytes depend on the picture alone.
export function small_png(picture) {
  const {width, height, pixel} = picture;
  const counts = new Map();
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) counts.set(pixel(x, y), (counts.get(pixel(x, y)) ?? 0) + 1);
  }
  const palette = palette_of(counts);
  const index = new Map(palette.flatMap(({colours}, i) => colours.map(colour => [colour, i])));
  const rows = Buffer.alloc(height * (width + 1));
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) rows[y * (width + 1) + 1 + x] = index.get(pixel(x, y));
  }
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 3, 0, 0, 0], 8);
  return Buffer.concat([
    kSignature, chunk('IHDR', head), chunk('PLTE', Buffer.concat(palette.map(({colour}) => colour))),
    chunk('IDAT', zlib.deflateSync(rows, {level: 9, memLevel: 9})), chunk('IEND', Buffer.alloc(0)),
  ]);
}

function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type, 'latin1'), data]);
  const ends = Buffer.alloc(8);
  ends.writeUInt32BE(data.length, 0);
  ends.writeUInt32BE(crc32(body), 4);
  return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
}

function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return (crc ^ 0xffffffff) >>> 0;
}
