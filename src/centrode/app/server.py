"""The server of the workbench: on this machine alone, for the page that it has given its token to."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import html
import json
import secrets
import time
from collections import deque
from collections.abc import AsyncIterator, Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.requests import ClientDisconnect, Request
from starlette.responses import HTMLResponse, JSONResponse, PlainTextResponse, Response
from starlette.routing import BaseRoute, Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket, WebSocketDisconnect

from centrode.app.folders import WorkFolder
from centrode.app.workers import ProcessRunner, Reply, Runner, StartFailure
from centrode.locale import LANGUAGES, _, chosen_language, mark, speaking

STATIC = Path(__file__).parent / "static"
MESSAGE_SIZE = 2_000_000
"""Bytes of a message; the longest text of a description, its letters escaped, takes 1.8 million."""
WAITING = 32
"""Messages of a page that wait; of one that sends more, the connection is closed."""
QUICK, SLOW = 20.0, 180.0
"""Seconds that an answer may take, and that of a panel or a file."""
SLOW_NAMES = ("panel", "export", "page", "synthesise")
HOSTS = ("127.0.0.1", "localhost")
WARMING = "[points]\nA = [0, 0]\nB = [1, 0]\n[frame]\npoints = ['A']\n[links.AB]\n[[drives]]\nlink = 'AB'\nspeed = 1\n"
TOO_LONG = mark("this takes too long"), mark("give fewer samples, or a shorter range")
INTERRUPTED = mark("the computation was interrupted"), mark("try again")
NOT_STARTED = (
    mark("the process that computes does not start: {reason}"),
    mark(
        "install what is missing and start the workbench again; another text, or a page that is loaded again, tries "
        "once more"
    ),
)
NO_MESSAGE = mark("the server does not know this request"), ""
TOO_LARGE = mark("this file is too large for a description"), ""
REFUSED = (
    mark("No workbench runs at this address. Open the address that centrode app prints."),
    mark("To read a link to a description, paste it into the workbench under Open."),
)
"""What is wrong, and its repair."""
CODE_SECONDS = 120.0
"""So long a browser that the command starts has to bring its code: the first start of one may take a minute."""
GIVEN = '<meta name="workbench" content="">'
"""Where the page finds what the server gives it."""
HEADERS = {
    "Content-Security-Policy": (
        "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; "
        "connect-src 'self' ws://127.0.0.1:* ws://localhost:*; frame-ancestors 'none'; base-uri 'none'; "
        "form-action 'self'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class OneTimeCodes:
    """Codes that stand for the token once, and for a short time.

    The address that starts a browser stands in its list of arguments, which every user of the machine can read. A code
    there is worth nothing once the browser has brought it.
    """

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        self._now = now
        self._until: dict[str, float] = {}

    def issue(self) -> str:
        """Another code."""
        code = secrets.token_urlsafe(24)
        self._until[code] = self._now() + CODE_SECONDS
        return code

    def redeem(self, code: object) -> bool:
        """Whether a code is good; it is not any more after this."""
        until = self._until.pop(code, None) if isinstance(code, str) else None
        return until is not None and self._now() <= until


@dataclass(frozen=True)
class ServerSettings:
    """What a server serves.

    Attributes
    ----------
    work : the folder and the file
    port : at which it listens
    token : that a page has to bring
    codes : each of which brings a page the token, once
    """

    work: WorkFolder
    port: int
    token: str = field(default_factory=lambda: secrets.token_urlsafe(24))
    codes: OneTimeCodes = field(default_factory=OneTimeCodes, compare=False)

    @property
    def address(self) -> str:
        """What a person opens; it brings the chosen language where that is not English."""
        return self._address_with(f"token={self.token}")

    def opening_address(self) -> str:
        """What starts a browser: an address that is good once, since others may read it."""
        return self._address_with(f"code={self.codes.issue()}")

    def _address_with(self, credential: str) -> str:
        language = chosen_language()
        wished = "" if language == "en" else f"&language={language}"
        return f"http://127.0.0.1:{self.port}/?{credential}{wished}"

    def is_own_host(self, host: str | None) -> bool:
        """Whether a request came by a name of this machine: another one may point here (DNS rebinding)."""
        return host in {f"{name}:{self.port}" for name in HOSTS}

    def is_own_origin(self, origin: str | None) -> bool:
        """Whether a page of this server sends a request."""
        return origin in {f"http://{name}:{self.port}" for name in HOSTS}

    def has_token(self, token: object) -> bool:
        """Whether a token is that of this server."""
        return isinstance(token, str) and secrets.compare_digest(token.encode(), self.token.encode())


@dataclass
class RequestLanes:
    """What computes: one for what a page waits for at once, one for what takes longer."""

    quick: Runner
    slow: Runner

    def end(self) -> None:
        """End both."""
        self.quick.end()
        self.slow.end()


def server_application(
    settings: ServerSettings, make: Callable[[WorkFolder], Runner] = ProcessRunner
) -> Starlette:
    """The application that uvicorn runs.

    Parameters
    ----------
    make : makes what computes; tests compute in their own process
    """
    lanes = RequestLanes(make(settings.work), make(settings.work))

    @contextlib.asynccontextmanager
    async def lifespan(_application: Starlette) -> AsyncIterator[None]:
        # what computes loads its libraries while the browser opens the page
        warming = [asyncio.create_task(_warm(runner)) for runner in (lanes.quick, lanes.slow)]
        try:
            yield
        finally:
            for task in warming:
                task.cancel()
            await asyncio.gather(*warming, return_exceptions=True)
            lanes.end()

    return Starlette(routes=Endpoints(settings, lanes).routes(), lifespan=lifespan)


@dataclass(frozen=True)
class Endpoints:
    """What answers at each address of the workbench, for this machine's names and holders of the token alone."""

    settings: ServerSettings
    lanes: RequestLanes

    def routes(self) -> list[BaseRoute]:
        """Addresses with what answers there."""
        pages = {"/": "index.html", "/gears": "gears.html", "/synthesis": "synthesis.html"}
        routes: list[BaseRoute] = [
            *(Route(path, functools.partial(self.open_page, name=name)) for path, name in pages.items()),
            Route("/export", self.export, methods=["POST"]),
            Route("/page", self.page),
            WebSocketRoute("/socket", self.socket),
        ]
        if STATIC.is_dir():
            routes.append(Mount("/static", _OwnFiles(self.settings, directory=STATIC)))
        return routes

    async def open_page(self, request: Request, name: str) -> Response:
        """A page of the workbench, with the token where the request has it or a code that is good for it."""
        settings = self.settings
        said = "\n".join(_spoken_error(REFUSED, _preferred_language(request)).values())
        token, code = (request.query_params.get(key) for key in ("token", "code"))
        if not _is_own_request(settings, request):
            return PlainTextResponse(said, 403, HEADERS)
        allowed = settings.has_token(token) if code is None else settings.codes.redeem(code)
        if not allowed and (token is not None or code is not None):
            return PlainTextResponse(said, 403, HEADERS)
        # a window that is loaded again has kept the token, and its address does not hold it
        given = {"token": settings.token} if allowed else {"refused": said}
        return _page_with(given, name)

    async def export(self, request: Request) -> Response:
        """A file of the description that the body of the request holds."""
        if not self.settings.is_own_origin(request.headers.get("origin")):
            return _refuse(403)
        try:
            given = await _bounded_json(request)
        except ClientDisconnect:
            return _refuse(400)
        if given is None:
            return JSONResponse(
                {"error": _spoken_error(TOO_LARGE, _preferred_language(request))}, 413, HEADERS
            )
        refused = _refusal(self.settings, request, given.get("token"))
        if refused is not None:
            return refused
        return await _file(self.lanes.slow, {**given, "do": "export", "token": ""})

    async def page(self, request: Request) -> Response:
        """The page of a mechanism that computes itself."""
        refused = _refusal(self.settings, request, request.query_params.get("token"))
        if refused is not None:
            return refused
        names = ("digest", "language")
        message = {key: request.query_params[key] for key in names if key in request.query_params}
        return await _file(self.lanes.quick, {**message, "do": "page"})

    async def socket(self, socket: WebSocket) -> None:
        """The conversation of a window: requests and answers, until it closes."""
        settings = self.settings
        own = settings.is_own_host(socket.headers.get("host")) and settings.is_own_origin(
            socket.headers.get("origin")
        )
        if not own or not settings.has_token(socket.query_params.get("token")):
            await socket.close(1008)
            return
        await socket.accept()
        await Conversation(socket, self.lanes).hold()


async def _warm(runner: Runner) -> None:
    """A message whose answer nobody waits for: what serves the first page has begun then."""
    with contextlib.suppress(TimeoutError, EOFError, OSError):
        await runner.answer({"id": 0, "do": "read", "text": WARMING}, SLOW)


class _OwnFiles(StaticFiles):
    """Files of the page, for this machine's names only."""

    def __init__(self, settings: ServerSettings, *, directory: Path) -> None:
        super().__init__(directory=directory)
        self._settings = settings

    async def get_response(self, path: str, scope: Any) -> Response:
        if not self._settings.is_own_host(Request(scope).headers.get("host")):
            return _refuse(403)
        response = await super().get_response(path, scope)
        response.headers.update(HEADERS)
        return response


def _page_with(given: Mapping[str, str], name: str) -> Response:
    """A page with what the server gives it."""
    try:
        page = (STATIC / name).read_text("utf-8")
    except OSError:
        return PlainTextResponse("the page is not built", 500, HEADERS)
    content = html.escape(json.dumps(given, ensure_ascii=False))
    return HTMLResponse(page.replace(GIVEN, GIVEN.replace('""', f'"{content}"')), headers=HEADERS)


def _is_own_request(settings: ServerSettings, request: Request) -> bool:
    """Whether a request came by a name of this machine, and from no page of another one."""
    origin = request.headers.get("origin")
    own = origin is None or settings.is_own_origin(origin)
    return own and settings.is_own_host(request.headers.get("host"))


def _refusal(settings: ServerSettings, request: Request, token: object) -> Response | None:
    """The answer to a request that is not allowed; None to one that is."""
    allowed = _is_own_request(settings, request) and settings.has_token(token)
    return None if allowed else _refuse(403)


def _refuse(status: int) -> Response:
    return PlainTextResponse("refused", status, HEADERS)


async def _bounded_json(request: Request) -> dict[str, Any] | None:
    """The body as a table; None where it is too great, or none."""
    content = bytearray()
    async for part in request.stream():
        content += part
        if len(content) > MESSAGE_SIZE:
            return None
    return message_of(content)


def message_of(content: str | bytes | bytearray) -> dict[str, Any] | None:
    """A message; None of what is none."""
    try:
        message = json.loads(content)
    except (ValueError, RecursionError):
        return None
    return message if isinstance(message, dict) else None


async def _file(runner: Runner, message: Mapping[str, Any]) -> Response:
    """A file that a message asks for, or why there is none."""
    try:
        reply = await runner.answer(message, SLOW)
    except TimeoutError:
        return JSONResponse(_error_of(message, TOO_LONG), 503, HEADERS)
    except StartFailure as failure:
        return JSONResponse(_error_of(message, NOT_STARTED, reason=failure.reason), 503, HEADERS)
    except (EOFError, OSError):
        return JSONResponse(_error_of(message, INTERRUPTED), 503, HEADERS)
    if isinstance(reply, str):
        return Response(reply, 422, {**HEADERS, "Content-Type": "application/json"})
    length = int.from_bytes(reply[:4], "little")
    header = json.loads(reply[4 : 4 + length])
    name = "".join(letter for letter in header["name"] if letter.isalnum() or letter in "-_. ") or "file"
    ascii_name = name.encode("ascii", "replace").decode().replace("?", "_")
    headers = {
        **HEADERS,
        "Content-Type": header["type"],
        "Content-Disposition": f'attachment; filename="{ascii_name}"',
    }
    return Response(reply[4 + length :], 200, headers)


class Conversation:
    """The messages of one page: answered in turn, of drags that wait only the last one."""

    def __init__(self, socket: WebSocket, lanes: RequestLanes) -> None:
        self.socket, self.lanes = socket, lanes
        self.waiting: dict[bool, deque[dict[str, Any]]] = {False: deque(), True: deque()}
        self.arrived = {False: asyncio.Event(), True: asyncio.Event()}
        self.running: asyncio.Task[Reply] | None = None

    async def hold(self) -> None:
        """Answer until the page goes."""
        work = [asyncio.create_task(self._work(slow)) for slow in (False, True)]
        try:
            while True:
                message = await self._receive()
                if message is not None and not await self._take(message):
                    break
        except (WebSocketDisconnect, RuntimeError):
            pass
        finally:
            for task in work:
                task.cancel()
            await asyncio.gather(*work, return_exceptions=True)

    async def _receive(self) -> dict[str, Any] | None:
        got = await self.socket.receive()
        if got["type"] == "websocket.disconnect":
            raise WebSocketDisconnect
        content = got.get("text") or got.get("bytes") or ""
        message = message_of(content) if len(content) <= MESSAGE_SIZE else None
        if message is None:
            await self._send(json.dumps(_error_of({}, NO_MESSAGE)))
        return message

    async def _take(self, message: dict[str, Any]) -> bool:
        """Put a message into its queue; False where too many wait."""
        slow = message.get("do") in SLOW_NAMES
        queue = self.waiting[slow]
        if slow or message.get("do") == "drag":
            # the page has gone on: what waits of this kind is answered by the newer one
            for old in [one for one in queue if one.get("do") == message.get("do") and not one.get("drop")]:
                queue.remove(old)
                await self._send(json.dumps({"id": _number(old), "superseded": True}))
        if slow and self.running is not None:
            self.running.cancel()
        queue.append(message)
        self.arrived[slow].set()
        if len(queue) > WAITING:
            await self.socket.close(1008)
            return False
        return True

    async def _work(self, slow: bool) -> None:
        queue, arrived = self.waiting[slow], self.arrived[slow]
        runner, limit = (self.lanes.slow, SLOW) if slow else (self.lanes.quick, QUICK)
        while True:
            await arrived.wait()
            arrived.clear()
            while queue:
                message = queue.popleft()
                await self._send(await self._answer(runner, message, limit, slow))

    async def _answer(self, runner: Runner, message: dict[str, Any], limit: float, slow: bool) -> Reply:
        task = asyncio.create_task(runner.answer(message, limit))
        self.running = task if slow else self.running
        try:
            return await task
        except TimeoutError:
            return json.dumps(_error_of(message, TOO_LONG))
        except asyncio.CancelledError:
            current = asyncio.current_task()
            if current is not None and current.cancelling():
                task.cancel()
                raise
            return json.dumps({"id": _number(message), "superseded": True})
        except StartFailure as failure:
            return json.dumps(_error_of(message, NOT_STARTED, reason=failure.reason))
        except (EOFError, OSError):
            return json.dumps(_error_of(message, INTERRUPTED))
        finally:
            if slow:
                self.running = None

    async def _send(self, reply: Reply) -> None:
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):
            if isinstance(reply, str):
                await self.socket.send_text(reply)
            else:
                await self.socket.send_bytes(reply)


def _error_of(message: Mapping[str, Any], error: tuple[str, str], **values: str) -> dict[str, Any]:
    """The answer that says what went wrong with a message, in its language."""
    return {"id": _number(message), "error": _spoken_error(error, message.get("language"), **values)}


def _spoken_error(error: tuple[str, str], language: object, **values: str) -> dict[str, str]:
    with speaking(language if isinstance(language, str) and language in LANGUAGES else "en"):
        what, repair = error
        said = _(what).format(**values) if values else _(what)
        return {"message": said, "repair": _(repair) if repair else ""}


def _preferred_language(request: Request) -> str:
    """The language that a browser asks for first."""
    return request.headers.get("accept-language", "")[:2].lower()


def _number(message: Mapping[str, Any]) -> int:
    number = message.get("id")
    return number if isinstance(number, int) and not isinstance(number, bool) else 0
