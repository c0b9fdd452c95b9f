"""What is kept in files is what was made; a file that is not whole is made again."""

import hashlib
import io
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trocar.errors import InputError
from trocar.model import Press
from trocar.waves.mesh.basis_cache import BasisCache, cache_folder, fingerprint
from trocar.waves.mesh.block import block_mesh
from trocar.waves.mesh.solid_mesh import Held
from trocar.waves.mesh.wave_mesh import WaveMesh
from waves.mesh.meshes import ACROSS, LAYERS, THROUGH

ARRAYS = (np.arange(5.0), np.arange(12.0).reshape(3, 4))
SMALL = block_mesh(LAYERS, (ACROSS[::4], ACROSS[::4], THROUGH))
PRESS = Press(x=0.01, y=0.01, radius=2e-3, force=0.05)


class Maker:
    def __init__(self):
        self.calls = 0

    def __call__(self):
        self.calls += 1
        return ARRAYS


def same(found):
    return all(np.array_equal(one, other) for one, other in zip(found, ARRAYS, strict=True))


def test_what_was_made_is_not_made_again(tmp_path):
    make, cache = Maker(), BasisCache(tmp_path / "waves")
    assert same(cache.remembered("key", make))
    assert same(BasisCache(tmp_path / "waves").remembered("key", make))
    assert make.calls == 1
    cache.remembered("other", make)
    assert make.calls == 2


def torn(content, place):
    return content[:place]


def flipped(content, place):
    return content[:place] + bytes([content[place] ^ 0x10]) + content[place + 1 :]


@pytest.mark.parametrize("harm", [torn, flipped])
def test_a_file_that_is_not_whole_is_made_again(tmp_path, harm):
    make, cache = Maker(), BasisCache(tmp_path)
    cache.remembered("key", make)
    (path,) = tmp_path.iterdir()
    whole = path.read_bytes()
    for number, place in enumerate(range(0, len(whole), 7), start=2):
        path.write_bytes(harm(whole, place))
        assert same(cache.remembered("key", make))
        assert make.calls == number
        assert path.read_bytes() == whole


class Trap:
    def __reduce__(self):
        return pytest.fail, ("a pickle was opened",)


def test_a_pickle_is_not_opened(tmp_path):
    stream = io.BytesIO()
    np.savez(stream, np.array([Trap()], dtype=object))
    content = stream.getvalue()
    (tmp_path / "key.basis").write_bytes(hashlib.sha256(content).digest() + content)
    make = Maker()
    assert same(BasisCache(tmp_path).remembered("key", make))
    assert make.calls == 1


def test_the_folder_stays_small(tmp_path):
    one = (tmp_path / "one", np.zeros(1000))
    size = 8 * 1000 + 600
    cache = BasisCache(tmp_path, largest=3 * size)
    for name in "abc":
        cache.remembered(name, lambda: (one[1],))
    for age, name in enumerate("abc"):
        os.utime(tmp_path / f"{name}.basis", (age, age))
    cache.remembered("a", lambda: (one[1],))  # read: no longer the oldest
    cache.remembered("d", lambda: (one[1],))
    assert sorted(path.stem for path in tmp_path.iterdir()) == ["a", "c", "d"]
    cache.remembered("large", lambda: (np.zeros(10_000),))
    assert not (tmp_path / "large.basis").exists()


def test_what_a_killed_writer_left_is_swept(tmp_path):
    left, fresh = tmp_path / ".x.basis.partial-1", tmp_path / ".y.basis.partial-2"
    for path in (left, fresh):
        path.write_bytes(b"half")
    os.utime(left, (1, 1))
    BasisCache(tmp_path).remembered("key", Maker())
    assert sorted(path.name for path in tmp_path.iterdir()) == [".y.basis.partial-2", "key.basis"]


def test_readers_and_writers_do_not_meet(tmp_path):
    def work(_):
        return all(same(BasisCache(tmp_path).remembered("key", Maker())) for _ in range(20))

    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(work, range(4)))


def test_a_folder_that_cannot_be_written_to_only_costs_time(tmp_path):
    (tmp_path / "file").write_text("no folder")
    make = Maker()
    assert same(BasisCache(tmp_path / "file").remembered("key", make))
    assert make.calls == 1
    with pytest.raises(InputError, match="bytes above 0"):
        BasisCache(tmp_path, largest=0)


def test_the_folder_is_where_the_records_are(monkeypatch, tmp_path):
    monkeypatch.setenv("TROCAR_DATA", str(tmp_path))
    assert cache_folder() == tmp_path / "waves"
    monkeypatch.delenv("TROCAR_DATA")
    assert cache_folder().name == "waves"
    assert "trocar" in cache_folder().parts


@pytest.mark.parametrize(
    "change",
    [
        {"corners": SMALL.corners * (1 + 1e-15)},
        {"materials": (replace(LAYERS.layers[0], density=1101), *LAYERS.layers[1:])},
        {"materials": (replace(LAYERS.layers[0], prony=((0.5, 1.0),)), *LAYERS.layers[1:])},
        {"region": np.zeros_like(SMALL.region)},
        {"held": SMALL.held[:1]},
        {"held": (Held(faces=SMALL.held[0].faces, along=(True, False, True)), *SMALL.held[1:])},
        {"surfaces": {"cover": SMALL.surfaces["cover"]}},
    ],
)
def test_every_input_is_in_the_name(change):
    assert fingerprint(replace(SMALL, **change), 5) != fingerprint(SMALL, 5)
    assert fingerprint(SMALL, 6) != fingerprint(SMALL, 5)
    assert fingerprint(replace(SMALL), 5) == fingerprint(SMALL, 5)


def test_a_model_out_of_the_cache_is_the_same(tmp_path, monkeypatch):
    points = np.array([[0.01, 0.01, 0.0], [0.012, 0.009, 0.0]])
    first, again = (WaveMesh(SMALL, modes=5, cache=BasisCache(tmp_path)) for _ in range(2))
    one = first.displacement(first.static((PRESS,)), points)
    monkeypatch.setattr("trocar.waves.mesh.assembled.Factored", None)  # nothing is factored any more
    assert np.array_equal(again.displacement(again.static((PRESS,)), points), one)
    assert {path.suffix for path in Path(tmp_path).iterdir()} == {".basis"}
