// SPDX-License-Identifier: MIT
// Plans over HTTP, then follows a drag over the socket, by the door of `camway view` (docs/http.md). Node 22,
// or Node 20 with --experimental-websocket: node door.mjs "$(cat door.url)" request.json
import { readFileSync } from "node:fs";

const [, , door, file] = process.argv;
if (!file) {
  console.error("usage: door.mjs ADDRESS REQUEST; `camway view` prints the address");
  process.exit(2);
}
const url = new URL(door.trim());
const token = url.searchParams.get("token");
const request = JSON.parse(readFileSync(file, "utf8"));

async function ask(method, place, body) {
  const response = await fetch(url.origin + place, {
    method,
    headers: { authorization: `Bearer ${token}` },
    body: body && JSON.stringify(body),
  });
  const answer = await response.json();
  if (!response.ok) throw new Error(answer.error);
  return answer;
}

const answer = await ask("POST", "/v1/plan", request);
console.log(`planned: ${answer.status}, ${answer.segments.length} segments`);

// While somebody drags a keyframe: of the requests with the same `drag`, the last one wins.
const socket = new WebSocket(`ws://${url.host}/v1/socket?token=${token}`);
await new Promise((open, fail) => {
  socket.addEventListener("open", open);
  socket.addEventListener("error", () => fail(new Error("the socket does not open")));
});
const last = 20;
const dragged = new Promise((done, fail) => {
  socket.addEventListener("message", ({ data }) => {
    const message = JSON.parse(data);
    if (message.error) fail(new Error(message.error));
    if (message.id === last && message.answer) done(message.answer);
  });
});
for (let id = 1; id <= last; ++id) {
  request.keyframes[0].position[0] += 0.001;
  socket.send(JSON.stringify({ id, do: "plan", drag: "first", request }));
}
console.log(`dragged: ${(await dragged).status}`);
socket.close();
