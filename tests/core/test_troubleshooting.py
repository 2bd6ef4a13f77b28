# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/troubleshooting.md quotes messages that are in the sources, word for word, and leaves out none of the library's.

A message stands on the page in bold code, with N for numbers, and NAME, REASON and the like for other words that vary.
In the sources it is a string with holes: a format of C, an f-string, a string of bash. What stands in a hole is such a
word, or another string of the sources."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import lru_cache

import pytest
from conftest import CHECKOUT

PAGE = (CHECKOUT / "docs" / "troubleshooting.md").read_text(encoding="utf-8")
QUOTED = [" ".join(text.split()) for _, text in re.findall(r"\*\*(`+)(.+?)\1\*\*", PAGE, re.DOTALL)]
HOLE = "\0"
VARIES = re.compile(r"([\"'(]*\b(N|[A-Z]{4,})\b[^a-zA-Z]*)*")
FOR_PROGRAMS = {  # statuses that no mesh and no setting of a person leads to
    "ORB_OK", "ORB_INDEX_OUT_OF_RANGE", "ORB_BAD_ARGUMENT", "ORB_BAD_WEIGHT",
}


def strings_of_c(text: str) -> Iterator[tuple[str, str]]:
    """Neighbouring literals are one string. With the text before it."""
    for found in re.finditer(r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*', text):
        joined = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', found[0]))
        yield re.sub(r"%[-.0-9]*(?:ll|l|z)?[a-z]", HOLE, joined), text[: found.start()][-300:]


def strings_of_python(text: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value
        elif isinstance(node, ast.JoinedStr):
            yield "".join(str(part.value) if isinstance(part, ast.Constant) else HOLE for part in node.values)


def strings_of_bash(text: str) -> Iterator[str]:
    for found in re.findall(r'"((?:[^"\\\n]|\\.)*)"', text):
        yield re.sub(r"\$\{[^}]*\}|\$\([^)]*\)|\$[A-Za-z0-9*@]+", HOLE, found)


@lru_cache
def strings() -> frozenset[str]:
    """All of the sources."""
    found: set[str] = set()
    for path in (CHECKOUT / "native" / "src").glob("*.c"):
        found |= {string for string, _ in strings_of_c(path.read_text(encoding="utf-8"))}
    for path in (CHECKOUT / "addon").rglob("*.py"):
        found |= set(strings_of_python(path.read_text(encoding="utf-8")))
    for path in (CHECKOUT / "build.sh", *(CHECKOUT / "addon").glob("*.sh")):
        found |= set(strings_of_bash(path.read_text(encoding="utf-8")))
    return frozenset(found)


@lru_cache
def patterns() -> list[re.Pattern[str]]:
    """Of those that say something."""
    return [pattern(string) for string in sorted(strings()) if len(re.findall("[A-Za-z]", string)) > 8]


def pattern(string: str) -> re.Pattern[str]:
    text = re.sub(f"{HOLE}+", HOLE, string.replace("\\n", " ").strip().rstrip("."))
    return re.compile("(.*?)".join(re.escape(part) for part in text.split(HOLE)), re.IGNORECASE)


def matches(one: re.Pattern[str], message: str) -> bool:
    found = one.fullmatch(message.removeprefix("error: ").rstrip("."))
    return found is not None and all(fills(text) for text in found.groups())


def fills(text: str) -> bool:
    """Whether this can stand in a hole."""
    return VARIES.fullmatch(text) is not None or text in strings() or is_there(text)


@lru_cache(maxsize=None)
def is_there(message: str) -> bool:
    return any(matches(one, message) for one in patterns())


@pytest.mark.parametrize("message", QUOTED)
def test_message_is_in_the_sources(message: str) -> None:
    assert is_there(message)


def test_what_is_not_in_the_sources_is_noticed() -> None:
    assert not is_there("the mesh is shut: N holes with N edges in all")
    assert not is_there("SIGNATURE has N cones but N edges were picked")


def test_each_status_has_an_entry() -> None:
    header = (CHECKOUT / "native" / "include" / "orbifold.h").read_text(encoding="utf-8")
    enum = header.partition("typedef enum orb_status {")[2].partition("}")[0]
    statuses = set(re.findall(r"\b(ORB_[A-Z_]+)\b", enum)) | {"ORB_NO_LIBRARY"}
    assert len(statuses) > 25
    assert {status for status in statuses - FOR_PROGRAMS if f"`{status}`" not in PAGE} == set()


def test_no_error_of_the_library_is_left_out() -> None:
    wanted = []
    for path in sorted((CHECKOUT / "native" / "src").glob("*.c")):
        for string, before in strings_of_c(path.read_text(encoding="utf-8")):
            call = re.search(r"error_set(?:_elements)?\(\s*error,\s*(ORB_[A-Z_]+),[^;\"]*$", before)
            if call and call[1] not in FOR_PROGRAMS:
                wanted.append(pattern(string))
    assert len(wanted) > 40
    assert [one.pattern for one in wanted if not any(matches(one, message) for message in QUOTED)] == []
