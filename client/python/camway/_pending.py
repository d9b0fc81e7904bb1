# SPDX-License-Identifier: MIT
"""A request for a path that is being answered."""
from __future__ import annotations

import asyncio
import concurrent.futures
import weakref
from collections.abc import Generator
from typing import TYPE_CHECKING, Any

from camway import _errors

if TYPE_CHECKING:
    from camway import _native, _types

    _FutureOfAnswer = concurrent.futures.Future[_types.Answer]
else:
    _FutureOfAnswer = concurrent.futures.Future


class PendingPlan(_FutureOfAnswer):
    """The future of an answer: `result()` waits for it, and `await` does in a coroutine. Cancelling the task
    that awaits it cancels the request."""

    def __init__(self, client: _native.NativeClient) -> None:
        """Made by `Client.plan_async` alone."""
        super().__init__()
        # The client holds this object until the answer has come, so this one does not hold the client.
        self._client = weakref.ref(client)
        self._request_id = 0
        # From here on `cancel` asks the daemon, whose answer ends the future.
        self.set_running_or_notify_cancel()

    @property
    def request_id(self) -> int:
        """The id of the request; 0 if nothing was sent."""
        return self._request_id

    def result(self, timeout: float | None = None) -> _types.Answer:
        """Waits for the answer, at most `timeout` seconds; raises TimeoutError after that. Raises Busy in a handler of
        the client, without whose end no answer comes."""
        self._refuse_to_wait()
        return super().result(timeout)

    def exception(self, timeout: float | None = None) -> BaseException | None:
        """Waits, as `result` does, and returns the error in place of an answer; None if there is an answer."""
        self._refuse_to_wait()
        return super().exception(timeout)

    def cancel(self) -> bool:
        """Has the daemon cancel the request. The future ends soon: with `camway.Cancelled`, or with the finished
        answer if there is one. Returns False if it has ended."""
        client = self._client()
        if self.done() or client is None:
            return False
        client.cancel(self._request_id)
        return True

    def __await__(self) -> Generator[Any, None, _types.Answer]:
        return asyncio.wrap_future(self).__await__()

    def _refuse_to_wait(self) -> None:
        client = self._client()
        if client is not None and not self.done():
            client.refuse_to_wait()

    def _take(self, answer: _types.Answer) -> None:
        if self.done():
            return
        self._request_id = answer.request_id
        if answer.status in _errors.RESULTS:
            self.set_result(answer)
        else:
            self.set_exception(_errors.error_of(answer.status, answer.error, answer))

    def _abandon(self) -> None:
        """Ends the future of a client that was closed while another thread waited in it."""
        if not self.done():
            self.set_exception(_errors.NoAnswer("the client was closed before the answer came"))
