from __future__ import annotations

import gettext
import subprocess
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from centrode import locale
from centrode.cli.translation import wished_language
from centrode.errors import InputError

Run = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(autouse=True)
def english_again() -> Iterator[None]:
    yield
    locale.choose_language("en")


@pytest.mark.parametrize(
    ("environment", "language"),
    [
        ({}, "en"),
        ({"LANG": "ru_RU.UTF-8"}, "ru"),
        ({"LANG": "uk_UA"}, "uk"),
        ({"LANG": "ru_RU.UTF-8", "LC_ALL": "uk_UA.UTF-8"}, "uk"),
        ({"LANG": "ru_RU.UTF-8", "LC_ALL": "C"}, "en"),
        ({"LANGUAGE": "de:uk:ru", "LANG": "ru_RU.UTF-8"}, "uk"),
        ({"LANG": "de_DE.UTF-8"}, "en"),
        ({"LANG": "C.UTF-8"}, "en"),
        ({"LANG": "ru@cyrillic"}, "ru"),
    ],
)
def test_language_of_environment(environment: dict[str, str], language: str) -> None:
    assert locale.language_of(environment) == language


def test_unknown_language_is_refused() -> None:
    with pytest.raises(InputError, match="'fr' is not one of en, ru, uk"):
        locale.choose_language("fr")


@pytest.mark.parametrize(
    ("arguments", "language"),
    [
        (["--lang", "ru", "examples"], "ru"),
        (["examples", "--lang=uk"], "uk"),
        (["--lang", "ru", "examples", "--lang", "uk"], "uk"),
        (["examples", "--lang", "fr"], None),
        (["examples", "--lang"], None),
        (["examples", "--", "--lang", "ru"], None),
        ([], None),
    ],
)
def test_language_is_read_before_or_after_the_command(arguments: list[str], language: str | None) -> None:
    assert wished_language(arguments) == language


@pytest.mark.parametrize(
    ("language", "words"),
    [
        (
            "ru",
            {
                1: "механизм",
                2: "механизма",
                5: "механизмов",
                11: "механизмов",
                21: "механизм",
                104: "механизма",
            },
        ),
        (
            "uk",
            {
                1: "механізм",
                3: "механізми",
                5: "механізмів",
                12: "механізмів",
                31: "механізм",
                102: "механізми",
            },
        ),
        ("en", {1: "mechanism", 2: "mechanisms", 21: "mechanisms"}),
    ],
)
def test_plural_forms(language: str, words: dict[int, str]) -> None:
    locale.choose_language(language)
    for count, word in words.items():
        sentence = locale.ngettext("{count} mechanism", "{count} mechanisms", count).format(count=count)
        assert sentence == f"{count} {word}"


@pytest.mark.parametrize(
    ("language", "sentences"),
    [
        ("en", ("1 sample is given", "0 samples are given", "2.5 samples are given")),
        ("ru", ("задан 1 отсчёт", "задано 0 отсчётов", "задано 2.5 отсчётов")),
        ("uk", ("задано 1 відлік", "задано 0 відліків", "задано 2.5 відліків")),
    ],
)
def test_numbers_of_all_kinds_have_a_grammatical_number(language: str, sentences: tuple[str, ...]) -> None:
    """Whole numbers of numpy count as those of Python; what is not whole, somebody's slip, takes the plural."""
    locale.choose_language(language)
    for number, sentence in zip((np.int64(1), 0, 2.5), sentences, strict=True):
        words = locale.ngettext("{n} sample is given", "{n} samples are given", number)
        assert words.format(n=number) == sentence


def test_empty_text_is_not_the_header() -> None:
    locale.choose_language("ru")
    assert locale._("") == ""


@pytest.mark.parametrize(
    ("arguments", "code", "russian", "ukrainian"),
    [
        (
            ["--help"],
            0,
            ["Использование:", "Команды:", "Параметры:"],
            ["Використання:", "Команди:", "Параметри:"],
        ),
        (
            ["examples", "--help"],
            0,
            ["Аргументы:", "ФАЙЛ", "эту справку"],
            ["Аргументи:", "ФАЙЛ", "цю довідку"],
        ),
        (
            ["nothing"],
            2,
            ["Ошибка: Нет такой команды: 'nothing'"],
            ["Помилка: Немає такої команди: 'nothing'"],
        ),
        (["--nothing"], 2, ["Нет такого параметра: '--nothing'"], ["Немає такого параметра: '--nothing'"]),
        (["examples", "a", "b"], 2, ["Лишние аргументы (b)"], ["Зайві аргументи (b)"]),
        (["examples", "--out"], 2, ["нужно значение"], ["потрібне значення"]),
        (["--version"], 0, ["centrode, версия"], ["centrode, версія"]),
    ],
)
def test_clicks_own_sentences_are_translated(
    centrode: Run, arguments: list[str], code: int, russian: list[str], ukrainian: list[str]
) -> None:
    for environment, sentences in ({"LANG": "ru_RU.UTF-8"}, russian), ({"LC_ALL": "uk_UA.UTF-8"}, ukrainian):
        done = centrode(*arguments, **environment)
        assert done.returncode == code
        for sentence in sentences:
            assert sentence in done.stdout + done.stderr


def test_choice_of_the_option_wins_over_the_environment(process: Run, centrode: Run) -> None:
    assert "Usage:" in process("--lang", "en", "--help", LANG="ru_RU.UTF-8").stdout
    assert "Використання:" in centrode("examples", "--help", "--lang", "uk", LANG="ru_RU.UTF-8").stdout


def test_unknown_language_ends_with_2_in_the_language_of_the_environment(centrode: Run) -> None:
    done = centrode("examples", "--lang", "fr", LANG="ru_RU.UTF-8")
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Неверное значение '--lang'" in done.stderr


def test_a_terminal_without_cyrillic_gets_question_marks(process: Run) -> None:
    done = process("--lang", "ru", "--help", PYTHONIOENCODING="latin-1")
    assert done.returncode == 0
    assert "?????????" in done.stdout


def test_the_process_speaks_for_the_standard_library_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANGUAGE", "en")
    domain = gettext.textdomain()
    try:
        locale.choose_language_of_process("uk")
        assert gettext.gettext("Missing command.") == "Не вказано команду."
    finally:
        gettext.textdomain(domain)
