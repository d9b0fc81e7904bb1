# SPDX-License-Identifier: MIT
"""A path that a daemon watches."""
from __future__ import annotations

import asyncio
import collections
import concurrent.futures
import threading
import weakref
from collections.abc import AsyncIterator, Callable, Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from types import TracebackType

    from camway import _native, _types


class Watch:
    """The events of a watched path: to iterate over, with `for` or `async for`, until the watch has ended. As a
    context, its end ends the watch. Thread-safe."""

    def __init__(self, client: _native.NativeClient, request: _types.Request,
                 on_event: Callable[[_types.WatchEvent], None] | None) -> None:
        """Made by `Client.watch` alone."""
        if on_event is not None and not callable(on_event):
            raise TypeError(f"on_event: must be a function, not {type(on_event).__name__}")
        # The client holds this object while it watches, so this one does not hold the client.
        self._client = weakref.ref(client)
        self._on_event = on_event
        self._lock = threading.Lock()
        self._events: collections.deque[_types.WatchEvent] = collections.deque()
        self._waiting: collections.deque[concurrent.futures.Future[_types.WatchEvent | None]] = collections.deque()
        self._has_ended = False
        self._request_id = client.watch(request, self._take)

    @property
    def request_id(self) -> int:
        """The id of the request; 0 if it could not be sent."""
        return self._request_id

    def next_event(self, timeout_s: float | None = None) -> _types.WatchEvent:
        """Waits for the next event. Raises TimeoutError if none comes in time, and EOFError after the event
        "ended" or `unwatch`. For watches without a handler. Raises Busy in a handler of the client, without whose end
        no event comes."""
        future, client = self._next(), self._client()
        try:
            if client is not None and not future.done():
                client.refuse_to_wait()
            event = future.result(timeout_s)
        except BaseException as error:
            self._withdraw(future)
            if isinstance(error, TimeoutError):
                raise TimeoutError(f"no event came within {timeout_s} s") from None
            raise
        if event is None:
            raise EOFError("the watch has ended")
        return event

    def take_better(self) -> None:
        """Has the daemon watch the better path that it offered last instead of the present one. The event "answer"
        confirms it. Handlers may call it."""
        client = self._client()
        if client is not None:
            client.take_better(self._request_id)

    def unwatch(self, timeout_s: float | None = None) -> bool:
        """Ends the watch. With a timeout, waits until the daemon has confirmed that, and returns whether it has.
        Iterations end."""
        client, confirmed = self._client(), timeout_s is None
        if client is not None and not client.is_closed:
            if timeout_s is None:
                client.unwatch(self._request_id)
            else:
                confirmed = client.unwatch_and_wait(self._request_id, timeout_s)
        self._end()
        return confirmed

    def __enter__(self) -> Watch:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.unwatch()

    def __iter__(self) -> Iterator[_types.WatchEvent]:
        return self

    def __next__(self) -> _types.WatchEvent:
        try:
            return self.next_event()
        except EOFError:
            raise StopIteration from None

    def __aiter__(self) -> AsyncIterator[_types.WatchEvent]:
        return self

    async def __anext__(self) -> _types.WatchEvent:
        future = self._next()
        try:
            event = await asyncio.wrap_future(future)
        except BaseException:
            self._withdraw(future)
            raise
        if event is None:
            raise StopAsyncIteration
        return event

    def _take(self, event: _types.WatchEvent) -> None:
        if self._on_event is not None:
            self._on_event(event)
        else:
            self._give(event)
        if event.kind == "ended":
            self._end()

    def _give(self, event: _types.WatchEvent) -> None:
        with self._lock:
            while self._waiting:
                future = self._waiting.popleft()
                if future.set_running_or_notify_cancel():
                    future.set_result(event)
                    return
            self._events.append(event)

    def _end(self) -> None:
        with self._lock:
            self._has_ended = True
            while self._waiting:
                future = self._waiting.popleft()
                if future.set_running_or_notify_cancel():
                    future.set_result(None)

    def _next(self) -> concurrent.futures.Future[_types.WatchEvent | None]:
        """Returns the future of the next event; of None after the last one."""
        future: concurrent.futures.Future[_types.WatchEvent | None] = concurrent.futures.Future()
        with self._lock:
            if self._events:
                future.set_result(self._events.popleft())
            elif self._has_ended:
                future.set_result(None)
            else:
                self._waiting.append(future)
        return future

    def _withdraw(self, future: concurrent.futures.Future[_types.WatchEvent | None]) -> None:
        """Gives back the event of a future that nobody waits for any more."""
        if future.cancel() or not future.done() or future.cancelled():
            return
        event = future.result()
        if event is not None:
            with self._lock:
                self._events.appendleft(event)
