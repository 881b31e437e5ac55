# SPDX-License-Identifier: Apache-2.0
import shutil
import subprocess
import threading
import warnings

import numpy as np
import pytest

import lamina

SIZE = (48, 36)


@pytest.fixture
def session(blob, function):
    return lamina.Session(blob, function, size=SIZE, context="cpu")


def test_after_changes_it_draws_what_a_new_one_draws(session, blob, function):
    session.draw()
    session.camera = lamina.Camera.orbit(blob, 60, 10)
    other = lamina.TransferFunction([(0.2, "red", 0), (1, "yellow", 6)])
    session.transfer_function = other
    session.size = (40, 20)
    session.set(clip={"planes": [{"point": [1, 1, 1.5], "normal": [1, 0, 0]}]})
    fresh = lamina.render(blob, other, camera=lamina.Camera.orbit(blob, 60, 10), size=(40, 20), context="cpu",
                          clip={"planes": [{"point": [1, 1, 1.5], "normal": [1, 0, 0]}]})
    assert np.array_equal(session.draw().array, fresh.array)
    assert session.size == (40, 20) and session.camera == lamina.Camera.orbit(blob, 60, 10)
    session.set(slice={"samples": 20, "classification": "post"}, target="fixed16", max_error=2)
    picture = session.draw()
    assert picture.plan.slabs == 20 and picture.plan.target == "fixed16"


def test_what_is_automatic_is_kept_until_it_is_chosen_again(session):
    first = session.camera
    session.set(transfer_function={"points": [{"value": 0.9, "extinction": 0}, {"value": 1, "extinction": 50}]})
    session.draw()
    assert session.camera == first
    session.choose_again()
    assert session.camera != first
    session.camera = first
    assert session.camera == first
    session.camera = "auto"
    assert session.camera != first


def test_a_failed_change_leaves_it_as_it_was(session):
    expected = session.draw().array.copy()
    for keywords, error in [({"target": "fixed99"}, lamina.Error), ({"size": (0, 5)}, lamina.Error), ({"siez": 5}, TypeError),
                            ({"size": 5}, TypeError), ({"set": {"render.slcie.samples": 5}}, lamina.Error)]:
        with pytest.raises(error):
            session.set(**keywords)
        assert np.array_equal(session.draw().array, expected)


def test_turntable(session):
    heard = []
    table = session.turntable(6, progress=lambda activity, share: heard.append(share))
    assert len(table) == 6 and heard[-1] == 1
    assert np.array_equal(session.draw().array, table[0].array)
    assert not any(np.array_equal(table[0].array, picture.array) for picture in table[1:])
    camera = session.camera
    session.camera = camera.turned(60)
    assert np.array_equal(session.draw().array, table[1].array)
    assert len(table[2:4]) == 2
    with pytest.raises(ValueError, match="views"):
        session.turntable(0)


def test_a_turntable_moves(session, tmp_path):
    table = session.turntable(3)
    table.save(tmp_path / "a.png")
    moving = (tmp_path / "a.png").read_bytes()
    assert [moving.count(kind) for kind in (b"acTL", b"fcTL", b"IEND")] == [1, 3, 1]
    # Programs that do not know APNG show the first picture.
    table[0].save(tmp_path / "first.png")
    assert lamina.compare(tmp_path / "a.png", tmp_path / "first.png").linf == 0


def shown_by(film):
    """The time and the checksum of each decoded frame."""
    done = subprocess.run(["ffmpeg", "-v", "error", "-i", film, "-f", "framemd5", "-"], check=True, capture_output=True)
    return done.stdout


def test_films_are_those_of_the_command_line(blob, function, program, tmp_path):
    session = lamina.Session(blob, function, size=(48, 36), context="cpu", annotations={"title": "T"})
    views = session.turntable(4)
    heard = []
    films = [("a.apng", [])]
    if shutil.which("ffmpeg"):
        films += [("a.mp4", ["--fps", "10"]), ("a.webm", []), ("a.gif", ["--fps", "10"])]
    session.resolved_scene.save(tmp_path / "scene.json")
    for name, options in films:
        subprocess.run([program, "render", tmp_path / "scene.json", "-o", tmp_path / f"c{name}", "--turntable", "4",
                        "--context", "cpu", "--quiet", *options], check=True)
        views.save(tmp_path / name, **({"fps": 10} if options else {}), progress=lambda activity, share: heard.append(activity))
        # An encoder's marks of time may differ in a file, but not what it shows, and when.
        if name == "a.apng":
            assert (tmp_path / name).read_bytes() == (tmp_path / f"c{name}").read_bytes()
        else:
            assert shown_by(tmp_path / name) == shown_by(tmp_path / f"c{name}")
    assert len(films) == 1 or "encoding frames" in heard
    lamina.save_film(list(views), tmp_path / "b.apng")
    assert (tmp_path / "b.apng").read_bytes() == (tmp_path / "a.apng").read_bytes()


def test_films_that_cannot_be_are_refused(session, tmp_path):
    picture = session.draw()
    clear = lamina.render(picture.scene, transparent=True, size=SIZE, context="cpu")
    for pictures, name, fps, message in (([picture], "a.avi", 25, 'suffix ".avi", expected .mp4, .webm, .gif or .apng'),
                                         ([], "a.apng", 25, "no frames"), ([picture], "a.apng", 0, "0 frames a second"),
                                         ([picture], "a.gif", 60, "at most 50"), ([clear], "a.mp4", 25, "no straight alpha"),
                                         ([picture, lamina.render(picture.scene, size=(10, 8))], "a.apng", 25, "differ in size"),
                                         ([picture, lamina.render(picture.scene, size=(10, 8))], "a.gif", 25, "differ in size"),
                                         ([picture], "none/a.apng", 25, "cannot write")):
        with pytest.raises(lamina.Error, match=message):
            lamina.save_film(pictures, tmp_path / name, fps=fps)
    with pytest.raises(TypeError, match="expected pictures"):
        lamina.save_film([3], tmp_path / "a.apng")
    with pytest.raises(TypeError, match="^pictures: found one picture, expected a list of them$"):
        lamina.save_film(picture, tmp_path / "a.apng")
    with pytest.raises(TypeError, match="^fps: found 2.5, expected a whole number$"):
        lamina.save_film([picture], tmp_path / "a.apng", fps=2.5)
    assert not list(tmp_path.iterdir())


def test_threads_do_not_disturb_each_other(blob, function):
    cameras = [lamina.Camera.orbit(blob, 40 * number) for number in range(4)]
    expected = [lamina.render(blob, function, camera=camera, size=SIZE, context="cpu").array for camera in cameras]
    shared, wrong = lamina.Session(blob, function, size=SIZE, context="cpu"), []

    def draw(number):
        own = lamina.Session(blob, function, camera=cameras[number], size=SIZE, context="cpu")
        for _ in range(5):
            if not np.array_equal(own.draw().array, expected[number]):
                wrong.append(number)
            shared.draw()  # threads take turns

    threads = [threading.Thread(target=draw, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_the_number_of_threads_changes_nothing(blob, function):
    one, all_ = (lamina.render(blob, function, size=SIZE, context="cpu", threads=n) for n in (1, 0))
    assert np.array_equal(one.array, all_.array)
    with pytest.raises(lamina.Error, match="threads"):
        lamina.Session(blob, function, threads=-1)
    with pytest.raises(ValueError, match="context: found \"gpu\", expected \"auto\""):
        lamina.Session(blob, function, context="gpu")


def test_the_cpu_engine_needs_no_opengl(tmp_path):
    import subprocess
    import sys
    code = ("import lamina, numpy\n"
            "lamina.render(numpy.ones((4, 4, 4), numpy.float32), size=(8, 6), context='cpu')\n"
            "maps = open('/proc/self/maps').read()\n"
            "assert 'liblamina' in maps\n"
            "print([name for name in ('libGL.', 'libEGL', 'libOSMesa', 'libGLX', 'libgallium') if name in maps])")
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"


SCENE = {"transfer_function": {"points": [{"value": 0, "color": [0, 0, 0], "extinction": 0},
                                          {"value": 200, "color": [1, 1, 1], "extinction": 1}]},
         "camera": {"eye": (40, 30, 20), "center": (7, 7, 7)}, "size": (40, 30)}


@pytest.mark.parametrize("kind", [np.uint8, np.float32])
@pytest.mark.parametrize("change", ["set", "roll", "slab", "sample"])
def test_an_array_that_was_changed_is_measured_again(kind, change):
    values = (np.random.default_rng(1).random((16, 16, 16)) * 200).astype(kind)
    session = lamina.Session(values, **SCENE)
    before = session.draw()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert session.draw().compare(before).linf == 0
    if change == "set":
        values[:] = 20
    elif change == "roll":
        values[:] = np.roll(values, 1, axis=0)
    elif change == "slab":
        values[3:13] = 0
    else:
        values[8, 8, 8] = 255 - values[8, 8, 8]
    draws = 16 if change == "sample" else 1  # a small change is seen within so many
    with pytest.warns(lamina.PictureWarning, match="was changed since it was read"):
        for _ in range(draws):
            after = session.draw()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert session.draw().compare(after).linf == 0
    expected = lamina.Session(values.copy(), **SCENE).draw()
    assert after.compare(expected).linf == 0
    values[:8] = 77
    with pytest.warns(lamina.PictureWarning, match="was changed since it was read"):
        truth = session.trace()
    assert truth.compare(lamina.Session(values.copy(), **SCENE).trace()).linf == 0


def test_what_nobody_can_write_to_is_not_looked_at():
    values = np.full((8, 8, 8), 90, np.uint8)
    assert lamina.Volume(values).copy()._watched() is None
    assert lamina.Volume(values)._watched() is not None
    view = values.view()
    view.setflags(write=False)
    assert lamina.Volume(view)._watched() is not None  # its base can be written
    values.setflags(write=False)
    assert lamina.Volume(values)._watched() is None
    assert lamina.Volume(np.full((8, 8, 8), 90, np.int64))._watched() is None  # it was converted


@pytest.mark.parametrize("columns", [slice(0, 512), slice(512, 1024)])
def test_changes_of_large_arrays_are_seen_wherever_they_are(columns):
    values = np.zeros((80, 1024, 1024), np.uint8)  # rows as long as a block of lines
    watched = lamina.Volume(values)._watched()
    assert not any(watched.is_changed() for _ in range(16))
    values[:, ::2, columns] = 1
    assert watched.is_changed()


def test_warnings_as_errors_do_not_hide_a_change():
    values = np.full((8, 8, 8), 90, np.uint8)
    session = lamina.Session(values, **SCENE)
    session.draw()
    values[:] = 200
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(lamina.PictureWarning):
            session.draw()
    assert session.draw().compare(lamina.Session(values.copy(), **SCENE).draw()).linf == 0


def test_a_copy_keeps_its_samples():
    values = np.full((8, 8, 8), 90, np.uint8)
    volume = lamina.Volume(values, spacing=(1, 2, 3), origin=(4, 5, 6), centers="cell")
    copied = volume.copy()
    values[:] = 0
    assert (copied.array == 90).all()
    assert (copied.spacing, copied.origin, copied.centers, copied.bounds) == (
        volume.spacing, volume.origin, volume.centers, volume.bounds)
