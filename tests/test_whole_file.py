"""A file is whole or not there."""

import pytest

from trocar.whole_file import write_whole


def test_a_file_takes_an_older_ones_place(tmp_path):
    place = tmp_path / "words.txt"
    place.write_text("old")
    write_whole(place, lambda stream: stream.write("new\r\n"))
    assert place.read_bytes() == b"new\r\n"
    assert [each.name for each in tmp_path.iterdir()] == ["words.txt"]


def test_what_fails_leaves_the_older_one_and_nothing_beside_it(tmp_path):
    place = tmp_path / "words.txt"
    place.write_text("old")

    def half(stream):
        stream.write("half")
        assert place.read_text() == "old"
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        write_whole(place, half)
    assert place.read_text() == "old"
    assert [each.name for each in tmp_path.iterdir()] == ["words.txt"]


def test_a_place_that_cannot_be_written_to_is_told(tmp_path):
    with pytest.raises(FileNotFoundError):
        write_whole(tmp_path / "no folder" / "words.txt", lambda stream: stream.write("new"))
