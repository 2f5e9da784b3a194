"""End of the process: by a signal, by the loss of its terminal, or by a quit.

A Python signal handler runs in the main thread between two bytecodes: never while that thread is in a
kernel, or writes to a terminal that nobody reads. So a thread of its own watches over the end: the
interpreter writes the number of every signal to a pipe as it comes (`signal.set_wakeup_fd`), and this
thread reads it. Whatever the others are at, the process is over soon after it was asked to end.
"""

from __future__ import annotations

import math
import os
import select
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from types import FrameType
from typing import IO, Any

from hough_tui.streams import reserve_descriptors

HUNG_UP, INTERRUPTED, TERMINATED = 128 + signal.SIGHUP, 128 + signal.SIGINT, 128 + signal.SIGTERM

WORDS = {HUNG_UP: "hung up", INTERRUPTED: "interrupted", TERMINATED: "terminated"}

GRACE = {HUNG_UP: 1.1, INTERRUPTED: 0.7, TERMINATED: 1.1}
"""Seconds for an end in order, after which the watch ends the process."""

FINISHING_SECONDS, AFTERWARDS_SECONDS = 10.0, 0.5
"""How much longer an end waits for what is being finished, such as keeping a run, and then for the rest."""

LAST_SECONDS = 0.6
"""The longest that what is done just before a forced end may take: a terminal may never take a byte."""


class EndedError(KeyboardInterrupt):
    """Request to end the process, raised in the main thread.

    Attributes
    ----------
    status : exit status of the process
    """

    def __init__(self, status: int) -> None:
        super().__init__()
        self.status = status


class EndingWatch:
    """Thread that ends the process where it does not end by itself.

    The first signal raises `EndedError` in the main thread; after `hand_over` it calls a function in
    this thread instead. A second interrupt ends the process at once.

    Attributes
    ----------
    status : exit status that the process was asked to end with; None before it was asked
    """

    def __init__(self) -> None:
        self.status: int | None = None
        self._deadline = math.inf
        self._interrupts = 0
        self._is_impatient = False
        self._raises = True
        self._unfinished = 0
        self._deferred: int | None = None
        # A signal handler may come between two lines of a request of the main thread.
        self._lock = threading.RLock()
        self._last_act = threading.Lock()
        self._on_request: Callable[[int], None] = _nothing
        self._at_last: Callable[[int], None] = _say
        self._poll = select.poll()
        reserve_descriptors()
        self._pipe, self._far_end = os.pipe()
        os.set_blocking(self._pipe, False)
        os.set_blocking(self._far_end, False)
        self._poll.register(self._pipe, select.POLLIN)

    def begin(self) -> None:
        """Start to watch; only the main thread may call it."""
        sys.unraisablehook = _without_endings
        signal.set_wakeup_fd(self._far_end, warn_on_full_buffer=False)
        for number in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM):
            # What nohup, or a shell in the background, has the process ignore stays ignored.
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._handle)
        threading.Thread(target=self._run, name="ending", daemon=True).start()

    def hand_over(
        self, on_request: Callable[[int], None], at_last: Callable[[int], None], terminal: int
    ) -> None:
        """Have signals and the loss of a terminal call a function, and raise nothing any more.

        Parameters
        ----------
        on_request : has the process end in order; it is given the exit status
        at_last : does what is left to do just before a forced end; it is given the exit status
        terminal : file descriptor of the terminal
        """
        self._raises = False
        self._on_request, self._at_last = on_request, at_last
        self._poll.register(terminal, 0)  # a hang-up is reported without being asked for
        self._wake()

    def request(self, status: int, grace: float) -> bool:
        """Ask the process to end within some seconds, from any thread; return whether nothing had yet."""
        with self._lock:
            if self.status is not None:
                return False
            self.status, self._deadline = status, time.monotonic() + grace
        self._wake()
        return True

    @contextmanager
    def finishing(self) -> Iterator[None]:
        """Let an end wait for what is done meanwhile, `FINISHING_SECONDS` at most.

        Raises
        ------
        EndedError
            Afterwards, in the main thread, where a signal came meanwhile.
        """
        with self._lock:
            self._unfinished += 1
        try:
            yield
        finally:
            with self._lock:
                self._unfinished -= 1
                if self.status is not None:
                    self._deadline = max(self._deadline, time.monotonic() + AFTERWARDS_SECONDS)
            self._wake()
        if self._deferred is not None and threading.current_thread() is threading.main_thread():
            number, self._deferred = self._deferred, None
            self._handle(number, None)

    def claim(self) -> None:
        """Leave the last act to the calling thread, which ends the process at once."""
        self._last_act.acquire()

    def over(self, error: BaseException) -> None:
        """End the process, if it was asked to, once its command is over; the caller is the main thread."""
        self._raises = False
        if isinstance(error, EndedError):
            self.request(error.status, 0.0)
        if self.status is not None:
            # Whatever else was raised came of it.
            for stream in (sys.stdout, sys.stderr):
                within(LAST_SECONDS, _flush, stream)
            self._is_impatient = True
            self._wake()
            threading.Event().wait()

    def _handle(self, number: int, _: FrameType | None) -> None:
        if self._unfinished:
            self._deferred = number
        elif self._raises:
            self._raises = False
            self.request(128 + number, GRACE[128 + number])
            raise EndedError(128 + number)

    def _run(self) -> None:
        # To set a terminal up from the background would stop the process.
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTTOU})
        while True:
            left = self._limit - time.monotonic()
            for descriptor, event in self._poll.poll(None if left == math.inf else 1000 * max(left, 0.0)):
                if descriptor == self._pipe:
                    for number in os.read(self._pipe, 4096):
                        self._signalled(number)
                else:
                    self._poll.unregister(descriptor)
                    if event & (select.POLLHUP | select.POLLERR):
                        self._asked(HUNG_UP)
            if time.monotonic() >= self._limit:
                self._end()

    @property
    def _limit(self) -> float:
        """When the process is ended, on the monotonic clock."""
        if self._is_impatient:
            return -math.inf
        return self._deadline + (FINISHING_SECONDS if self._unfinished else 0.0)

    def _signalled(self, number: int) -> None:
        if 128 + number in GRACE:
            self._asked(128 + number)
            if number == signal.SIGINT:
                self._interrupts += 1
                if self._interrupts > 1:
                    self._is_impatient = True

    def _asked(self, status: int) -> None:
        if self.request(status, GRACE[status]):
            within(GRACE[status], self._on_request, status)

    def _end(self) -> None:
        assert self.status is not None
        self.claim()
        try:
            within(LAST_SECONDS, self._at_last, self.status)
            workers = sys.modules.get("multiprocessing")
            for worker in workers.active_children() if workers else ():
                worker.kill()
        finally:
            # In order it could wait for ever, for a thread in a kernel or for a reader of what was printed.
            os._exit(self.status)

    def _wake(self) -> None:
        with suppress(BlockingIOError):  # a full pipe wakes the thread, too
            os.write(self._far_end, b"\0")


_watch: EndingWatch | None = None


@contextmanager
def watched() -> Iterator[None]:
    """Watch over the end of the process while its command runs, and from then on."""
    global _watch
    if _watch is None:
        reserve_descriptors()
        _watch = EndingWatch()
        _watch.begin()
    try:
        yield
    except BaseException as error:
        _watch.over(error)
        raise


def hand_over(on_request: Callable[[int], None], at_last: Callable[[int], None], terminal: int) -> None:
    """See `EndingWatch.hand_over`."""
    if _watch is not None:
        _watch.hand_over(on_request, at_last, terminal)


def request(status: int, grace: float) -> None:
    """Have the watch, if there is one, end the process where it has not ended in some seconds."""
    if _watch is not None:
        _watch.request(status, grace)


def finishing() -> AbstractContextManager[None]:
    """See `EndingWatch.finishing`."""
    return nullcontext() if _watch is None else _watch.finishing()


def claim() -> None:
    """See `EndingWatch.claim`."""
    if _watch is not None:
        _watch.claim()


def requested_status() -> int | None:
    """Return the exit status that the process was asked to end with; None before it was asked."""
    return None if _watch is None else _watch.status


def within(seconds: float, function: Callable[..., None], *arguments: Any) -> None:
    """Call a function that may block, and wait some seconds for it at most."""
    thread = threading.Thread(target=function, args=arguments, daemon=True)
    with suppress(RuntimeError):  # no more threads can be started: nothing may hold up the end
        thread.start()
        thread.join(seconds)


def _say(status: int) -> None:
    # No stream of Python's: it may be held by a thread that will never let it go.
    os.write(2, f"hough-tui: {WORDS[status]}\n".encode())


def _flush(stream: IO[str] | None) -> None:
    if stream is None:  # closed from the start
        return
    with suppress(OSError, ValueError):  # its reader is gone, or it is closed
        stream.flush()


def _nothing(_: int) -> None:
    """Leave the end to the exception in the main thread."""


def _without_endings(unraisable: Any) -> None:
    """Report what was raised where nothing can catch it, but not the request to end."""
    if not isinstance(unraisable.exc_value, EndedError):
        sys.__unraisablehook__(unraisable)
