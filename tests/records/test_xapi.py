"""Statements are valid: the rules are those of the Experience API 1.0.3, part two, checked one by one."""

import json
import re
from datetime import datetime
from urllib.parse import urlsplit
from uuid import UUID

import pytest

from score_cards import attempt
from trocar.errors import InputError
from trocar.records.xapi import duration, statements

VERBS = {f"http://adlnet.gov/expapi/verbs/{word}" for word in ("completed", "passed", "failed", "terminated")}
LANGUAGE = re.compile(r"[A-Za-z]{2,8}(-[A-Za-z0-9]{1,8})*")  # RFC 5646, as far as it is used here
DURATION = re.compile(r"P(?=.)(\d+Y)?(\d+M)?(\d+D)?(T(?=.)(\d+H)?(\d+M)?(\d+(\.\d+)?S)?)?")  # ISO 8601


def check_iri(text):
    parts = urlsplit(text)
    assert parts.scheme, text  # an IRI is absolute
    assert not re.search(r"[\s<>\"{}|\\^`]", text), text
    if parts.scheme == "urn":
        assert re.fullmatch(r"urn:[A-Za-z0-9][A-Za-z0-9-]{0,31}:\S+", text), text  # RFC 8141


def check_language_map(content):
    assert all(LANGUAGE.fullmatch(key) and isinstance(words, str) for key, words in content.items())


def check_extensions(content):
    assert isinstance(content, dict)
    for key in content:
        check_iri(key)


def check_score(score):
    assert score.keys() <= {"scaled", "raw", "min", "max"}
    assert all(isinstance(value, float) for value in score.values())
    assert -1 <= score["scaled"] <= 1
    assert score["min"] < score["max"]
    assert score["min"] <= score["raw"] <= score["max"]


def check(statement):
    assert statement.keys() <= {"id", "actor", "verb", "object", "result", "context", "timestamp"}
    assert str(UUID(statement["id"])) == statement["id"]
    actor = statement["actor"]
    assert actor["objectType"] == "Agent"
    assert actor.keys() & {"mbox", "mbox_sha1sum", "openid", "account"} == {
        "account"
    }  # exactly one identifier
    assert actor["account"].keys() == {"homePage", "name"}
    check_iri(actor["account"]["homePage"])
    assert actor["account"]["name"]
    check_iri(statement["verb"]["id"])
    assert statement["verb"]["id"] in VERBS
    check_language_map(statement["verb"]["display"])
    activity = statement["object"]
    assert activity["objectType"] == "Activity"
    check_iri(activity["id"])
    check_iri(activity["definition"]["type"])
    check_language_map(activity["definition"]["name"])
    check_extensions(activity["definition"]["extensions"])
    result = statement["result"]
    assert result.keys() <= {"score", "success", "completion", "response", "duration", "extensions"}
    assert all(isinstance(result[key], bool) for key in result.keys() & {"success", "completion"})
    assert DURATION.fullmatch(result["duration"])
    check_extensions(result.get("extensions", {}))
    if "score" in result:
        check_score(result["score"])
    assert isinstance(statement["context"]["platform"], str)  # allowed, since the object is an activity
    check_extensions(statement["context"]["extensions"])
    assert datetime.fromisoformat(statement["timestamp"]).utcoffset() is not None

    def no_null(value):
        for one in value.values() if isinstance(value, dict) else ():
            assert one is not None
            no_null(one)

    no_null(statement)


@pytest.fixture
def told(records):
    """Attempts that ended in every way there is, and one that runs."""
    attempt(records)
    attempt(records, passed=False, score=12.5)
    attempt(records, passed=False, completed=False, score=0.0)
    attempt(records, 'Zoë "Z" <x>', task="ring & thread", score=131.0)
    anna = records.trainee("Anna")
    for _ in range(2):
        number = records.begin(anna, task="palpate", level=3, device="web", header={}, dt=1e-3)
    records.interrupt(number, "the page was closed")
    return records


def test_every_attempt_that_ended_is_a_valid_statement(told):
    made = statements(told.attempts(), told.metrics())
    for one in json.loads(json.dumps(made, allow_nan=False)):
        check(one)
    words = [one["verb"]["display"]["en"] for one in made]
    assert words == ["passed", "failed", "failed", "passed", "terminated"]
    assert [one["result"]["completion"] for one in made] == [True, True, False, True, False]


def test_a_result_is_the_score_card(told):
    passed, _, _, quick, ended = (one["result"] for one in statements(told.attempts(), told.metrics()))
    assert passed["score"] == {"scaled": 0.8, "raw": 80.0, "min": 0.0, "max": 100.0}
    assert (passed["success"], passed["duration"]) == (True, "PT25.50S")
    assert passed["extensions"]["urn:trocar:metric:path_length_m"] == 0.5
    assert passed["extensions"]["urn:trocar:metric:impulse_n_s"] == 6.5
    assert "urn:trocar:metric:bimanual_dexterity" not in passed["extensions"]  # it does not exist
    assert (quick["score"]["raw"], quick["extensions"]["urn:trocar:score"]) == (100.0, 131.0)
    assert ended.keys() == {"completion", "duration", "extensions"}
    assert ended["extensions"] == {"urn:trocar:reason": "the page was closed"}


def test_a_statement_has_the_same_id_whenever_it_is_made(told):
    first, again = (statements(told.attempts(), told.metrics()) for _ in range(2))
    assert first == again
    assert len({one["id"] for one in first}) == len(first)
    other = statements(told.attempts(), told.metrics(), home_page="https://hospital.example/")
    assert {one["id"] for one in first}.isdisjoint(one["id"] for one in other)


def test_a_pseudonym_tells_no_name(told):
    made = statements(told.attempts(), told.metrics(), pseudonymous=True)
    names = [one["actor"]["account"]["name"] for one in made]
    assert names == ["trainee 1"] * 3 + ["trainee 2", "trainee 1"]
    assert "Anna" not in json.dumps(made)
    for one in made:
        check(one)


@pytest.mark.parametrize("home_page", ["", "hospital.example", "https://a b/", "ftp://hospital.example/"])
def test_a_home_page_is_an_address(home_page):
    with pytest.raises(InputError, match="home page"):
        statements([], {}, home_page=home_page)


@pytest.mark.parametrize(("seconds", "text"), [(0, "PT0.00S"), (25.504, "PT25.50S"), (3600, "PT3600.00S")])
def test_durations(seconds, text):
    assert duration(seconds) == text
    assert DURATION.fullmatch(text)
