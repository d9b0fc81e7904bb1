// SPDX-License-Identifier: MIT
// A proxy between browser and door that holds back what the door says, as a slow network does.
import http from 'node:http';
import net from 'node:net';
import {setTimeout as pause} from 'node:timers/promises';

/// Starts a proxy that holds each answer back, and each piece of what comes over a socket, for up to `longest_ms`. Of a
/// socket the order stays. Returns its address. It keeps no test from ending.
export async function start_slow_network(longest_ms) {
  const hold = () => pause(Math.random() * longest_ms);
  const proxy = http.createServer((request, answer) => {
    const {method, headers, url} = request;
    const asked = http.request(url, {method, headers}, async given => {
      await hold();
      answer.writeHead(given.statusCode, given.headers);
      given.pipe(answer);
    });
    asked.on('error', () => answer.destroy());
    answer.on('close', () => asked.destroy());
    request.pipe(asked);
  });
  proxy.on('connect', ({url}, browser, head) => {
    const {hostname, port} = new URL(`http://${url}`);
    const door = net.connect(port, hostname, () => {
      browser.write('HTTP/1.1 200 Connection established\r\n\r\n');
      door.write(head);
      browser.pipe(door);
    });
    let last = Promise.resolve();
    const later = act => (last = last.then(hold).then(act));
    door.on('data', piece => later(() => browser.writable && browser.write(piece)));
    door.on('close', () => later(() => browser.destroy()));
    door.on('error', () => browser.destroy());
    browser.on('error', () => door.destroy());
  });
  await new Promise(done => proxy.listen(0, '127.0.0.1', done));
  proxy.unref();
  return `http://127.0.0.1:${proxy.address().port}`;
}
