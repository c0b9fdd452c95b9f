"""A folder of results is whole or not there, and nobody else's folder is touched."""

import os

import pytest

from trocar.errors import InputError
from trocar.study.writing.folder import MARKERS, check_folder, fresh_folder, is_study


def fill(folder, text="new"):
    for name in (*MARKERS, "curves.csv"):
        (folder / name).write_text(text)
    (folder / "figures").mkdir()
    (folder / "figures" / "tap.svg").write_text(text)


def write(out, text="new"):
    with fresh_folder(out) as folder:
        fill(folder, text)


def write_and_raise(out, error):
    with fresh_folder(out) as folder:
        fill(folder)
        raise error


def names(folder):
    return sorted(entry.name for entry in folder.iterdir())


def test_a_new_folder_appears_with_its_parents(tmp_path):
    out = tmp_path / "a" / "b"
    write(out)
    assert is_study(out)
    assert names(out.parent) == ["b"]
    mask = os.umask(0)
    os.umask(mask)
    assert out.stat().st_mode & 0o777 == 0o777 & ~mask


def test_nothing_is_there_until_all_is_written(tmp_path):
    out = tmp_path / "study"
    with fresh_folder(out) as folder:
        fill(folder)
        assert not out.exists()
        assert folder.name.startswith(".study.partial-")
    assert out.exists()


def test_an_error_leaves_nothing(tmp_path):
    with pytest.raises(RuntimeError):
        write_and_raise(tmp_path / "study", RuntimeError("the disk is full"))
    assert names(tmp_path) == []


def test_an_error_leaves_an_earlier_study_as_it_was(tmp_path):
    out = tmp_path / "study"
    write(out, "old")
    with pytest.raises(KeyboardInterrupt):
        write_and_raise(out, KeyboardInterrupt())
    assert names(tmp_path) == ["study"]
    assert (out / "report.html").read_text() == "old"


def test_a_failing_rename_puts_the_earlier_study_back(tmp_path, monkeypatch):
    out = tmp_path / "study"
    write(out, "old")
    rename = type(out).rename

    def refuse(path, target):
        if path.name.startswith(".study.partial-"):
            raise OSError("no")
        return rename(path, target)

    monkeypatch.setattr(type(out), "rename", refuse)
    with pytest.raises(OSError, match="no"):
        write(out)
    assert names(tmp_path) == ["study"]
    assert (out / "report.html").read_text() == "old"


def test_an_earlier_study_is_replaced_whole(tmp_path):
    out = tmp_path / "study"
    write(out, "old")
    (out / "statistics.json").write_text("old")
    write(out)
    assert names(tmp_path) == ["study"]
    assert "statistics.json" not in names(out)
    assert (out / "report.html").read_text() == "new"


def test_an_empty_folder_and_a_link_to_a_study_are_taken(tmp_path):
    (tmp_path / "empty").mkdir()
    write(tmp_path / "empty")
    (tmp_path / "link").symlink_to(tmp_path / "empty")
    write(tmp_path / "link", "newer")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "empty" / "report.html").read_text() == "newer"


@pytest.mark.parametrize("stray", ["notes.txt", "figures/thesis.docx"])
def test_a_folder_with_somebodys_files_is_refused(tmp_path, stray):
    out = tmp_path / "study"
    write(out)
    (out / stray).write_text("mine")
    with pytest.raises(InputError, match="a folder with other files"):
        check_folder(out)
    assert (out / stray).read_text() == "mine"


def test_a_folder_without_our_marks_is_refused(tmp_path):
    (tmp_path / "report.html").write_text("mine")
    with pytest.raises(InputError, match="new, empty, or an earlier study's"):
        check_folder(tmp_path)


def test_a_folder_filled_while_the_study_ran_is_kept(tmp_path):
    out = tmp_path / "study"
    meanwhile = fresh_folder(out)
    fill(meanwhile.__enter__())
    out.mkdir()
    (out / "thesis.docx").write_text("mine")
    with pytest.raises(InputError):
        meanwhile.__exit__(None, None, None)
    assert names(tmp_path) == ["study"]
    assert names(out) == ["thesis.docx"]


def test_a_file_and_a_place_below_a_file_are_refused(tmp_path):
    (tmp_path / "file").write_text("mine")
    for out in (tmp_path / "file", tmp_path / "file" / "study"):
        with pytest.raises(InputError, match="file"):
            check_folder(out)


def test_a_place_that_may_not_be_written_is_an_error_of_the_system(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda _place, _mode: False)  # the superuser may write everywhere
    with pytest.raises(PermissionError, match="Permission denied"):
        check_folder(tmp_path / "study")


def test_the_folder_one_stands_in_is_not_replaced(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="the folder you stand in"):
        check_folder(tmp_path)
    assert tmp_path.is_dir()
