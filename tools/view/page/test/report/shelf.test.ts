// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { Review } from '../../src/contract/door.js';
import { jsonForHtml, Shelf } from '../../src/report/shelf.js';

const kHostile = '</script><script>alert(1)</script><!--$&$1\u2028';

const kElements: Record<string, unknown> = {
  'review-page': ['<body><script id="review">', '</script></body>'],
  'review-scenes': [
    { scene: { name: 'hall' }, objects: [{ digest: 'a', mesh_digest: 'mesh' }, { digest: 'b', mesh_digest: 'mesh' }, { digest: 'c' }] },
    { scene: { name: kHostile }, objects: [] },
  ],
  'review-meshes': { mesh: 'AAAA', c: 'CCCC', other: 'OOOO' },
  'review-0': { request: { keyframes: [] }, answer: { message: kHostile }, scene: 0, compared: { name: 'now', otherName: 'recorded', other: {} } },
  'review-7': { request: { keyframes: [] }, answer: { message: '' }, scene: 1 },
  'review-8': { request: { keyframes: [] }, answer: { message: '' }, scene: 2 },
};

const shelf = new Shelf((id) => (id in kElements ? JSON.stringify(kElements[id]) : undefined));

/** The data that the page of a review holds. */
function dataOf(page: string | undefined): Review {
  const parts = /^<body><script id="review">(.*)<\/script><\/body>$/s.exec(page ?? '');
  assert.ok(parts, page);
  assert.ok(!(parts[1] as string).includes('<'), 'nothing in the data begins a tag');
  return JSON.parse(parts[1] as string) as Review;
}

test('a review is joined with its scene and the meshes of that', () => {
  const { scene, ...rest } = kElements['review-0'] as { scene: number };
  assert.equal(scene, 0);
  const review = dataOf(shelf.page('0'));
  assert.deepEqual(review, {
    ...rest,
    scene: (kElements['review-scenes'] as unknown[])[0],
    meshes: { a: 'AAAA', b: 'AAAA', c: 'CCCC' },
  });
  assert.deepEqual(dataOf(shelf.page('7')).meshes, {});
});

test('texts of a log stay texts', () => {
  assert.equal(dataOf(shelf.page('0')).answer.message, kHostile);
  assert.equal(dataOf(shelf.page('7')).scene.scene.name, kHostile);
  assert.equal(JSON.parse(jsonForHtml(kHostile)), kHostile);
});

test('a report without a review, or with a scene that it lacks, shows none', () => {
  for (const number of ['1', '8', 'page', '']) assert.equal(shelf.page(number), undefined, number);
});
