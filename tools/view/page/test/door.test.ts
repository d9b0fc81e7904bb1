// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { lostMessage } from '../src/door/door.js';
import { DoorError } from '../src/door/socket.js';

test('a door that refuses the page is told from one that is away', () => {
  assert.match(lostMessage(new DoorError('the token is wrong', 403)), /Save your request first, then open the newly printed address/);
  for (const error of [new DoorError('busy', 503), new TypeError('Failed to fetch')]) assert.match(lostMessage(error), /goes on when it is back/);
});
