"""The server: for this machine and its own page alone, bounded, and never without an answer."""

from __future__ import annotations

import asyncio
import json
import random
import re
import time

import pytest

from centrode.app.answers import Workbench
from centrode.app.documents import TEXT_SIZE, digest_of
from centrode.app.folders import WorkFolder
from centrode.app.frames import read_frame
from centrode.app.server import CODE_SECONDS, MESSAGE_SIZE, OneTimeCodes, ServerSettings, server_application
from centrode.app.service import work_folder_of
from centrode.app.workers import DirectRunner, ProcessRunner, reply_to
from centrode.errors import InputError
from centrode.locale import speaking
from centrode.model.examples import example_names, example_text

from .conftest import ORIGIN

testing = pytest.importorskip("starlette.testclient")
websockets = pytest.importorskip("starlette.websockets")


SOCKET = f"{ORIGIN.replace('http', 'ws')}/socket"


def conversation(client, settings, **headers):
    return client.websocket_connect(f"{SOCKET}?token={settings.token}", headers=headers)


@pytest.mark.parametrize(
    ("headers", "token"),
    [
        ({"Host": "evil.example:8123"}, True),
        ({"Host": "127.0.0.1:9999"}, True),
        ({"Origin": "http://evil.example"}, True),
        ({"Origin": "null"}, True),
        ({}, False),
    ],
)
def test_strangers_are_refused(client, settings, headers, token):
    asked = settings.token if token else "x" * 32
    assert client.get(f"/?token={asked}", headers=headers).status_code == 403
    assert client.get(f"/page?token={asked}&digest=0", headers=headers).status_code == 403
    body = {"token": asked, "text": "", "topic": "model", "format": "xml"}
    assert client.post("/export", json=body, headers=headers).status_code == 403
    with (
        pytest.raises(websockets.WebSocketDisconnect),
        client.websocket_connect(f"{SOCKET}?token={asked}", headers=headers),
    ):
        raise AssertionError("it was let in")


def test_files_and_sockets_need_an_origin(settings):
    application = server_application(settings, DirectRunner)
    with testing.TestClient(application, base_url=ORIGIN) as plain:
        body = {"token": settings.token, "text": "", "topic": "model", "format": "xml"}
        assert plain.post("/export", json=body).status_code == 403
        with (
            pytest.raises(websockets.WebSocketDisconnect),
            plain.websocket_connect(f"{SOCKET}?token={settings.token}"),
        ):
            raise AssertionError("it was let in")


def test_a_page_draws_and_moves_a_mechanism(client, settings):
    with conversation(client, settings) as socket:
        socket.send_json({"id": 1, "do": "hello", "language": "en"})
        hello = socket.receive_json()
        assert hello["id"] == 1 and hello["words"]["undo"] and len(hello["templates"]) > 60
        socket.send_json({"id": 2, "do": "motion", "digest": digest_of("x")})
        assert socket.receive_json() == {"id": 2, "unknown": digest_of("x")}
        text = example_text("crank-rocker")
        socket.send_json({"id": 3, "do": "motion", "text": text, "samples": 37})
        header, arrays = read_frame(socket.receive_bytes())
        assert header["id"] == 3 and arrays["points"].shape == (37, 4, 2)
        socket.send_json({"id": 4, "do": "panel", "topic": "angles", "text": text})
        kinds = [block["kind"] for block in socket.receive_json()["blocks"]]
        assert "plot" in kinds


def test_files_are_downloaded(client, settings):
    body = {"token": settings.token, "text": example_text("crank-rocker"), "options": {}}
    table = client.post("/export", json={**body, "topic": "angles", "format": "csv"})
    assert table.status_code == 200 and table.text.startswith("time [s]")
    assert "attachment" in table.headers["content-disposition"]
    drawing = client.post("/export", json={**body, "topic": "drawing", "format": "dxf"})
    assert drawing.content.startswith(b"  0\nSECTION")
    refused = client.post("/export", json={**body, "topic": "flywheel", "format": "csv"})
    assert refused.status_code == 422 and "[machine]" in refused.json()["error"]["message"]
    unknown = client.post("/export", json={**body, "topic": "angles", "format": "exe"})
    assert unknown.status_code == 422


def test_what_is_too_big_is_refused(client, settings, ask):
    body = json.dumps({"token": settings.token, "text": "x" * MESSAGE_SIZE})
    assert client.post("/export", content=body).status_code == 413
    assert "allowed" in ask("read", text="x" * (TEXT_SIZE + 1))["error"]["message"]
    with conversation(client, settings) as socket:
        socket.send_text("x" * (MESSAGE_SIZE + 1))
        assert socket.receive_json()["error"]
        socket.send_text("[1, 2]")
        assert socket.receive_json()["error"]


@pytest.mark.parametrize(
    "name",
    [
        "../secret.toml", "/etc/passwd", "a/b.toml", "a\\b.toml", "..", "C:x.toml", "con.toml", ".hidden.toml",
        "a.txt", "a\n.toml", "", 7, None, "x" * 200 + ".toml",
    ],
)  # fmt: skip
def test_paths_outside_the_folder_are_refused(ask, name):
    assert "is no name" in ask("open", name=name)["error"]["message"]
    assert "is no name" in ask("save", name=name, text="")["error"]["message"]


def test_files_of_the_folder(ask, tmp_path):
    saved = ask("save", name="press.toml", text="title = 'a'\n")
    assert (tmp_path / "press.toml").read_text() == "title = 'a'\n"
    assert ask("files")["files"] == ["press.toml"]
    opened = ask("open", name="press.toml")
    assert opened["digest"] == saved["digest"]
    # somebody else writes it meanwhile
    (tmp_path / "press.toml").write_text("title = 'b'\n")
    refused = ask("save", name="press.toml", text="title = 'c'\n", expected=opened["digest"])
    assert "has changed" in refused["error"]["message"]
    assert (tmp_path / "press.toml").read_text() == "title = 'b'\n"
    new = ask("open", name="press.toml")["digest"]
    assert "error" not in ask("save", name="press.toml", text="title = 'c'\n", expected=new)
    assert "there is a file" in ask("save", name="press.toml", text="title = 'd'\n")["error"]["message"]


def test_links_out_of_the_folder_are_not_followed(ask, tmp_path):
    outside = tmp_path.parent / "outside.toml"
    outside.write_text("title = 'secret'\n")
    (tmp_path / "link.toml").symlink_to(outside)
    assert "not followed" in ask("open", name="link.toml")["error"]["message"]
    assert "error" in ask(
        "save", name="link.toml", text="title = 'x'\n", expected=digest_of("title = 'secret'\n")
    )
    assert outside.read_text() == "title = 'secret'\n"
    assert ask("files")["files"] == []


def test_great_files_are_refused(tmp_path):
    (tmp_path / "great.toml").write_bytes(b"#" * (4 * TEXT_SIZE + 1))
    with pytest.raises(InputError, match="bytes"):
        WorkFolder(tmp_path).read("great.toml")


def test_a_folder_is_worked_in_where_it_is_named(tmp_path):
    (tmp_path / "press.toml").mkdir()
    assert work_folder_of(tmp_path / "press.toml") == WorkFolder((tmp_path / "press.toml").resolve())
    with pytest.raises(InputError, match="this is not a file"):
        WorkFolder(tmp_path).read("press.toml")


def test_bad_texts_have_problems_at_their_lines(ask):
    text = example_text("crank-rocker").replace("length = 3.5", 'length = "x"')
    answer = ask("read", text=text)
    line = text.split("\n").index('length = "x"') + 1
    assert [(one["line"], one["path"]) for one in answer["problems"]] == [(line, "links.AB.length")]
    assert len(answer["scene"]["links"]) == 3
    broken = example_text("crank-rocker").replace("D = [4, 0]", "D = [4, 0")
    answer = ask("read", text=broken)
    assert answer["problems"][0]["line"] in (8, 9, 10, 11) and answer["scene"]["kind"] == "plane"
    loose = ask("read", text="[points]\nA = [0, 0]\nB = [1, 1]\n[links.AB]\n")
    assert [one["at"] for one in loose["scene"]["points"]] == [[0, 0], [1, 1]]
    assert loose["readiness"]["loose"] == ["A", "B"] and loose["readiness"]["missing"]


TEMPLATES = [*example_names(), *example_names("cam")]


@pytest.mark.parametrize("name", TEMPLATES)
def test_every_template_has_a_scene(ask, name):
    text = ask("example", name=name)["text"]
    answer = ask("read", text=text)
    assert answer["problems"] == [] and answer["readiness"]["ready"]
    assert json.loads(json.dumps(answer, allow_nan=False))["scene"]["topics"]


LETTERS = '"=[]{}#,.\n\\0aß\u2028'


def mutate(source, message):
    """A message with something changed: a value of another kind, a text with other letters, a key left out."""
    message = json.loads(json.dumps(message))
    key = source.choice(sorted(message))
    value = message[key]
    match source.randrange(5):
        case 0:
            del message[key]
        case 1:
            message[key] = source.choice(
                [None, True, -1, 1e308, "", [], {}, [[]], "\ud800", [1e400], {"a": {}}]
            )
        case 2 if isinstance(value, str) and value:
            at = source.randrange(len(value))
            message[key] = value[:at] + source.choice(LETTERS) + value[at + source.randrange(3) :]
        case 3 if isinstance(value, list) and value:
            message[key] = [source.choice([None, "x", -1e9, value])] * source.randrange(1, 4)
        case _:
            message[source.choice(["samples", "point", "to", "drive", "operations", "options"])] = (
                source.choice([None, -5, 10**12, "A", ["x"], {"at": ["1", "2"]}, [0.1, 0.2], 1e-300])
            )
    return message


def test_mutated_messages_have_answers(tmp_path):
    """No traceback, no hang, whatever a message holds: the fault of a program would be said as one."""
    bench = Workbench(WorkFolder(tmp_path))
    source = random.Random(28)
    text = example_text("crank-rocker")
    operations = [
        {"do": "move_point", "point": "B", "to": [2, 3]},
        {"do": "add_link", "at": [0, 0], "to": [1, 1]},
    ]
    messages = [
        {"do": "read", "text": text},
        {"do": "edit", "text": text, "operations": operations},
        {"do": "edit", "text": text, "operations": [{"do": "set", "path": "links.AB.length", "value": "4"}]},
        {"do": "drag", "text": text, "mode": "edit", "point": "B", "to": [2, 3]},
        {"do": "drag", "text": text, "mode": "move", "point": "B", "to": [2, 3], "drive": 0.1},
        {"do": "motion", "text": text, "samples": 5},
        {"do": "complete", "text": text, "line": 3, "column": 4},
        {"do": "open", "name": "a.toml"},
        {"do": "import", "url": "https://app.pmksplus.com/?0P.SS.K,0.101.."},
        {"do": "import", "name": "bars.svg", "content": "PHN2Zz48bGluZSB4Mj0iOSIvPjwvc3ZnPg=="},
    ]
    longest = 0.0
    for _k in range(1000):
        message = source.choice(messages)
        for _change in range(source.randrange(1, 4)):
            message = mutate(source, message) if message else messages[0]
        before = time.process_time()
        reply = reply_to(bench, {"id": 5, **message})
        longest = max(longest, time.process_time() - before)
        if isinstance(reply, str):
            assert "error in centrode" not in reply, (message, reply)
            assert "Traceback" not in reply
    assert longest < 30.0  # nothing hangs; the time itself belongs to benchmarks


def test_a_computation_that_is_stuck_is_stopped_and_the_next_one_answered(tmp_path):
    runner = ProcessRunner(WorkFolder(tmp_path))
    message = {"id": 1, "do": "hello", "language": "en"}

    async def talk():
        with pytest.raises(TimeoutError):
            await runner.answer(message, 1e-9)
        first = json.loads(await runner.answer(message, 120.0))
        assert runner._process is not None
        # the system, or somebody, ends the process: the next message starts another one
        runner._process.kill()
        second = json.loads(await runner.answer(message, 120.0))
        # JSON can hold half a pair of surrogates, which no text in UTF-8 can
        process = runner._process
        halved = json.loads(await runner.answer({"id": 3, "do": "read", "text": 'title = "\ud800"'}, 120.0))
        assert halved["id"] == 3 and runner._process is process
        runner.end()
        with pytest.raises(EOFError):
            await runner.answer(message, 120.0)
        assert runner._process is None
        return first, second

    try:
        first, second = asyncio.run(talk())
    finally:
        runner.stop()
    assert first == second and first["words"]


class FailingRunner(DirectRunner):
    """Fails at every message but the first, as what takes too long or is stopped."""

    failure: type[Exception] = TimeoutError

    async def answer(self, message, limit):
        if message.get("id") == 0:
            return "{}"
        raise self.failure


@pytest.mark.parametrize(
    ("failure", "words"), [(TimeoutError, "занадто довго"), (EOFError, "обчислення перервано")]
)
def test_what_fails_is_said_in_the_language_of_the_page(settings, failure, words, capfd):
    runner = type("Failing", (FailingRunner,), {"failure": failure})
    with testing.TestClient(
        server_application(settings, runner), base_url=ORIGIN, headers={"Origin": ORIGIN}
    ) as client:
        with conversation(client, settings) as socket:
            for number, name in enumerate(("read", "panel"), 1):
                socket.send_json({"id": number, "do": name, "text": "", "language": "uk"})
                answer = socket.receive_json()
                assert answer["id"] == number and words in answer["error"]["message"]
        body = {"token": settings.token, "text": "", "topic": "model", "format": "xml", "language": "uk"}
        file = client.post("/export", json=body)
        assert file.status_code == 503 and words in file.json()["error"]["message"]
        stranger = client.get("/?token=x", headers={"Accept-Language": "uk-UA,uk;q=0.9"})
        assert stranger.status_code == 403 and "виводить centrode app" in stranger.text
        great = client.post("/export", content=b" " * (MESSAGE_SIZE + 1), headers={"Accept-Language": "uk"})
        assert great.status_code == 413 and "файл" in great.json()["error"]["message"]
    assert "Traceback" not in "".join(capfd.readouterr())


def test_units_are_spelled_in_the_language(ask):
    units = {language: ask("hello", language=language)["units"] for language in ("en", "ru", "uk")}
    assert [units[language]["mm"] for language in ("en", "ru", "uk")] == ["mm", "мм", "мм"]
    assert units["en"].keys() == units["ru"].keys() == units["uk"].keys()


def test_a_folder_that_is_gone_is_said(ask, tmp_path):
    tmp_path.rmdir()
    assert "cannot be read" in ask("files")["error"]["message"]


def test_nothing_is_kept_that_a_message_cannot_bring_again(settings, tmp_path):
    text = example_text("crank-rocker")
    one, other = Workbench(settings.work), Workbench(settings.work)
    digest = one.answer({"id": 1, "do": "read", "text": text})["digest"]
    assert other.answer({"id": 2, "do": "read", "digest": digest}) == {"id": 2, "unknown": digest}
    again = other.answer({"id": 3, "do": "read", "text": text})
    assert again["scene"] == one.answer({"id": 1, "do": "read", "digest": digest})["scene"]


def test_the_address_brings_the_language_of_the_command(settings):
    assert settings.address == f"{ORIGIN}/?token={settings.token}"
    with speaking("uk"):
        assert settings.address == f"{ORIGIN}/?token={settings.token}&language=uk"


def test_tokens_differ(tmp_path):
    made = {ServerSettings(WorkFolder(tmp_path), 1).token for _k in range(20)}
    assert len(made) == 20 and all(len(token) >= 32 for token in made)


def test_a_code_is_good_once_and_not_for_long():
    now = [0.0]
    codes = OneTimeCodes(lambda: now[0])
    first, second, third = (codes.issue() for _ in range(3))
    assert codes.redeem(first) and not codes.redeem(first)
    now[0] = CODE_SECONDS
    assert codes.redeem(second)
    now[0] = CODE_SECONDS + 1.0
    assert not codes.redeem(third)
    assert not codes.redeem(None) and not codes.redeem("x")


def test_a_page_gets_the_token_by_a_code_and_says_what_to_do_without_one(client, settings):
    opening = settings.opening_address()
    assert settings.token not in opening
    assert settings.token in client.get(opening).text
    again = client.get(opening)
    assert again.status_code == 403 and settings.token not in again.text
    bare = client.get("/", headers={"Accept-Language": "ru"})
    assert bare.status_code == 200 and settings.token not in bare.text and "centrode app" in bare.text
    assert client.get("/", headers={"Host": "evil.example:8123"}).status_code == 403


@pytest.mark.parametrize("topic", ["reduce", "centres", "polygons", "rotatability"])
def test_numbers_of_panels_have_the_mark_of_the_language_and_names_stay(ask, topic):
    """A name that looks like a number is the user's: it keeps its point."""
    operation = {"do": "rename", "object": "slider", "name": "No 1.5"}
    text = ask("edit", text=example_text("six-bar-press"), operations=[operation])["text"]
    said = []
    for language in ("en", "uk"):
        blocks = ask("panel", text=text, topic=topic, language=language, samples=37)["blocks"]
        words = [block for block in blocks if block["kind"] in ("facts", "paragraph", "table", "heading")]
        said.append(json.dumps(words, ensure_ascii=False))
    english, ukrainian = said
    assert "No 1.5" in english and "No 1.5" in ukrainian
    printed = re.sub(
        r"(?<=[\[, ])-?\d+\.\d+(?=[\],])", "", ukrainian.replace("No 1.5", "")
    )  # JSON's own numbers
    assert re.search(r"\d,\d", printed) and not re.search(r"\d\.\d", printed)
    assert re.search(r"\d\.\d", english.replace("No 1.5", ""))
