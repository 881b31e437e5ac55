# SPDX-License-Identifier: Apache-2.0
"""The viewer in a window of Xvfb: scripts, xdotool, and files that are not what they were."""
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import time

if __name__ == "__main__":
    if not shutil.which("xvfb-run"):
        print("skipped: there is no xvfb-run")
        sys.exit(77)
    os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1600x1200x24", sys.executable, "-B", "-m", "pytest",
                           "-q", "-p", "no:cacheprovider", __file__])

import pytest

LAMINA = pathlib.Path(os.environ["LAMINA_PROGRAM"])
VIEWER = LAMINA.with_name("lamina-view")
LIMIT = 120


@pytest.fixture(autouse=True)
def surroundings(monkeypatch, tmp_path):
    monkeypatch.setenv("LIBGL_ALWAYS_SOFTWARE", "1")
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setenv("ASAN_OPTIONS", "detect_leaks=0")  # Mesa's
    monkeypatch.chdir(tmp_path)


def lamina(*arguments):
    return subprocess.run([LAMINA, *map(str, arguments)], check=True, capture_output=True, text=True, timeout=LIMIT)


def generated(name, size="24,24,24", kind="gaussians", sample_type="uint8"):
    lamina("generate", kind, "-o", name, "--size", size, "--type", sample_type)
    return name


def play(script, *arguments):
    pathlib.Path("script.txt").write_text(script)
    return subprocess.run([VIEWER, "--context", "cpu", "--script", "script.txt", *arguments], capture_output=True,
                          text=True, timeout=LIMIT)


def played(script, *arguments):
    result = play(script, *arguments)
    assert (result.returncode, result.stderr) == (0, "")
    return [json.loads(line) for line in result.stdout.splitlines()]


def size_of_png(name):
    header = pathlib.Path(name).read_bytes()[:24]
    return int.from_bytes(header[16:20], "big"), int.from_bytes(header[20:24], "big")


def difference(a, b):
    return json.loads(lamina("compare", a, b, "--json").stdout)["all"]


def test_what_is_saved_draws_the_picture_bit_for_bit():
    generated("a.nrrd")
    played("""
        wait full
        drag left 200 200 330 260 5
        wheel 2
        wait full
        save a.json
        save a.exr
        save a.png
        wait saved
        """, "a.nrrd")
    lamina("render", "a.json", "--context", "cpu", "-o", "b.exr")
    lamina("render", "a.json", "--context", "cpu", "-o", "b.png")
    assert difference("a.exr", "b.exr")["linf"] == 0
    assert pathlib.Path("a.png").read_bytes() == pathlib.Path("b.png").read_bytes()
    lamina("render", "a.nrrd", "--context", "cpu", "-o", "c.png")
    assert pathlib.Path("c.png").read_bytes() != pathlib.Path("b.png").read_bytes()


def test_the_error_that_is_shown_is_that_of_lamina_compare():
    generated("a.nrrd")
    measured, = played("""
        wait truth
        save a.json
        save a.exr
        wait saved
        measure end
        """, "--size", "160x120", "a.nrrd")
    lamina("render", "a.json", "--context", "cpu", "--method", "trace", "-o", "truth.exr")
    error = difference("a.exr", "truth.exr")
    assert measured["share_traced"] == 1
    assert measured["linf"] == error["linf"] > 0
    assert measured["l2"] == pytest.approx(error["l2"], rel=1e-9)  # printed with fewer digits, perhaps


def test_a_screenshot_shows_the_pixels_of_the_picture():
    generated("a.nrrd")
    played("set trace off\nset panels off\nsize 500 400\nwait full\nsave a.png\nwait saved\nwait 100\nscreenshot s.png",
           "a.nrrd")
    assert size_of_png("s.png") == (500, 400)
    width, height = size_of_png("a.png")
    assert width == 500 and 300 < height < 400


def test_the_window_takes_any_size():
    generated("a.nrrd")
    played("""
        set trace off
        wait full
        size 700 500
        wait full
        screenshot big.png
        size 60 50
        wait 300
        screenshot small.png
        size 900 700
        wait full
        screenshot again.png
        """, "a.nrrd")
    assert size_of_png("big.png") == (700, 500)
    assert size_of_png("again.png") == (900, 700)


def test_a_bad_file_is_a_message_and_what_was_open_stays():
    generated("a.nrrd")
    pathlib.Path("bad.json").write_text("{")
    pathlib.Path("gone.json").write_text('{"volume": {"path": "gone.nrrd"}}')
    for bad in ["bad.json", "gone.json", "nothing.nrrd"]:
        result = play(f"set trace off\nwait full\nopen {bad}\nwait 500\nscreenshot s.png\nkey F\nwait full\nsave a.json\n"
                      "wait saved", "a.nrrd")
        assert (result.returncode, result.stderr) == (0, ""), bad
        assert "a.nrrd" in pathlib.Path("a.json").read_text()
        result = play(f"open {bad}\nwait full")
        assert result.returncode == 1
        assert len(result.stderr.splitlines()) == 1 and bad.split(".")[0] in result.stderr
    assert play("wait full", "bad.json").returncode == 1


def test_a_volume_may_vanish_or_be_another_one():
    generated("a.nrrd")
    pathlib.Path("script.txt").write_text("""
        set trace off
        wait full
        measure first
        wait file changed
        drag left 200 200 250 220 3
        wait full
        open a.nrrd
        wait full
        save b.json
        save b.exr
        wait saved
        """)
    viewer = subprocess.Popen([VIEWER, "--context", "cpu", "--script", "script.txt", "a.nrrd"], stdout=subprocess.PIPE,
                              text=True)
    assert viewer.stdout.readline()
    pathlib.Path("a.nrrd").unlink()
    generated("a.nrrd", size="30,20,10", kind="marschner-lobb", sample_type="float")
    pathlib.Path("changed").touch()
    assert viewer.wait(LIMIT) == 0
    lamina("render", "b.json", "--context", "cpu", "-o", "c.exr")
    assert difference("b.exr", "c.exr")["linf"] == 0


def processor_seconds(process):
    user, system = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


def test_at_rest_it_takes_no_processor_time():
    generated("a.nrrd")
    pathlib.Path("script.txt").write_text("wait truth\nwait 300\nmeasure rest\nwait 6000")
    viewer = subprocess.Popen([VIEWER, "--context", "cpu", "--script", "script.txt", "--size", "100x80", "a.nrrd"],
                              stdout=subprocess.PIPE, text=True)
    assert viewer.stdout.readline()
    time.sleep(1)  # the last frames
    before = processor_seconds(viewer)
    time.sleep(4)
    assert processor_seconds(viewer) - before < .04  # 1 % of a core
    assert viewer.wait(LIMIT) == 0


def test_without_a_display_it_says_so(monkeypatch):
    monkeypatch.delenv("DISPLAY")
    for command in [[VIEWER], [LAMINA, "view"]]:
        result = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
        assert result.returncode == 1
        assert result.stderr.startswith("lamina-view: no display: ") and result.stderr.count("\n") == 1


@pytest.mark.parametrize("script, message", [("dance", "script.txt:1: found \"dance\", expected one of click"),
                                             ("\nclick 1", "script.txt:2: found \"click 1\", expected click X Y"),
                                             ("move a 1", "expected a number instead of \"a\""),
                                             ("key Nothing", "expected a key: A to Z"),
                                             ("set trace maybe", "expected on or off"),
                                             ("save a.gif", "found the suffix \".gif\"")])
def test_mistakes_in_scripts_are_named(script, message):
    result = play(script)
    assert result.returncode == 1
    assert message in result.stderr and len(result.stderr.splitlines()) == 1


def test_lamina_view_starts_the_viewer():
    generated("a.nrrd")
    pathlib.Path("script.txt").write_text("wait full\nsave a.npy\nwait saved")
    lamina("view", "a.nrrd", "--script", "script.txt", "--size", "40x30", "--context", "cpu")
    assert b"(30, 40, 4)" in pathlib.Path("a.npy").read_bytes()[:128]
    help_text = lamina("view", "--help").stdout
    assert "--script" in help_text
    alone = pathlib.Path("alone")
    alone.mkdir()
    shutil.copy(LAMINA, alone / "lamina")
    result = subprocess.run([alone / "lamina", "view"], capture_output=True, text=True, env={"PATH": "/nowhere"})
    assert result.returncode == 1
    assert "cannot start lamina-view" in result.stderr and len(result.stderr.splitlines()) == 1


def test_the_line_of_a_wipe_is_dragged_and_not_the_camera():
    generated("a.nrrd")
    played("""
        set trace off
        set panels off
        wait full
        save before.json
        wait saved
        key N
        screenshot plain.png
        key M
        wait 50
        screenshot wipe.png
        drag left 337 270 400 270 5
        wait 400
        screenshot dragged.png
        key V
        wait 50
        screenshot untraced.png
        save after.json
        wait saved
        """, "a.nrrd", "--size", "300x200")
    pictures = [pathlib.Path(name + ".png").read_bytes() for name in ["plain", "wipe", "dragged"]]
    assert len(set(pictures)) == 3
    before, after = (json.loads(pathlib.Path(name + ".json").read_text()) for name in ["before", "after"])
    assert before == after


KEYS = [*"ABCDEFHIJKLMNOPQRSTUVWXYZ0123456789", "Backspace", "Delete", "Down", "End", "Enter", "Escape", "F1", "Home", "Left",
        "Right", "Space", "Tab", "Up"]


def random_event(random):
    def place():
        return f"{random.randint(-20, 1300)} {random.randint(-20, 880)}"

    def held(*modifiers):
        return " ".join(random.sample(modifiers, random.choice([0, 0, 0, 1, len(modifiers)])))

    def key():
        name, modifiers = random.choice(KEYS), held("shift", "control")
        return f"key {name} {modifiers}" if (name, "control" in modifiers) != ("Q", True) else "key Q"

    button = random.choice(["left", "left", "left", "right", "middle"])
    return random.choice([
        lambda: f"move {place()}",
        lambda: f"press {button} {held('shift')}",
        lambda: f"release {button}",
        lambda: f"drag {button} {place()} {place()} {random.randint(1, 4)} {held('shift')}",
        lambda: f"click {place()} {held('shift', 'control')}",
        lambda: f"click {place()} {held('shift', 'control')}",
        lambda: f"doubleclick {place()}",
        lambda: f"wheel {random.uniform(-4, 4):.2f}",
        key,
        key,
        lambda: f"type {random.choice(['0', '1', '.5', '-3', '1e9', 'nan', '[4, 2]', 'x', '#$%'])}",
        lambda: f"set {random.choice(['coarse', 'trace', 'panels'])} {random.choice(['on', 'off'])}",
        lambda: f"wait {random.choice([0, 5, 40])}",
    ])()


# Settings that these events reach by chance may ask for a picture that takes minutes; opening a file ends it.
@pytest.mark.parametrize("seed", range(int(os.environ.get("LAMINA_VIEWER_SEEDS", "1"))))
def test_a_thousand_events_at_random_do_no_harm(seed):
    generated("a.nrrd")
    lamina("mesh", generated("b.nrrd", "6,5,4"), "--kuhn", "-o", "b.vtu")
    pathlib.Path("bad.json").write_text("{")
    choice = random.Random(seed)
    files = ["a.nrrd", "b.vtu", "bad.json", "b.nrrd"]
    events = [random_event(choice) for _ in range(1000)]
    for number in range(100, len(events), 100):
        events[number] = choice.choice([f"open {choice.choice(files)}",
                                        f"size {choice.randint(40, 1300)} {choice.randint(40, 900)}"])
    end = [*(f"release {button}" for button in ["left", "right", "middle"]), "open a.nrrd", "wait full", "save end.json",
           "save end.exr", "wait saved"]
    played("\n".join([*events, *end]), "a.nrrd", "--size", "160x120")
    lamina("render", "end.json", "--context", "cpu", "-o", "again.exr")
    assert difference("end.exr", "again.exr")["linf"] == 0


@pytest.mark.skipif(not shutil.which("xdotool"), reason="there is no xdotool")
def test_a_user_turns_the_picture_and_quits():
    generated("a.nrrd")
    viewer = subprocess.Popen([VIEWER, "--context", "cpu", "a.nrrd"])

    def xdotool(*arguments):
        return subprocess.run(["xdotool", *arguments], check=True, capture_output=True, text=True, timeout=LIMIT).stdout

    window = xdotool("search", "--sync", "--onlyvisible", "--name", "a.nrrd").split()[0]
    xdotool("mousemove", "300", "300", "mousedown", "1", "mousemove", "350", "320", "mouseup", "1", "click", "4")
    xdotool("windowunmap", window, "sleep", ".2", "windowmap", window, "sleep", ".2")
    xdotool("key", "f", "key", "p", "key", "F1", "key", "Tab", "key", "Tab")
    assert viewer.poll() is None
    xdotool("windowfocus", window, "key", "ctrl+q")
    assert viewer.wait(LIMIT) == 0
    settings = json.loads(pathlib.Path("config/lamina/viewer.json").read_text())
    assert settings["recent"] == [str(pathlib.Path("a.nrrd").absolute())]


def test_it_ends_at_once_while_it_works():
    """Not a measurement: a viewer that waited for its picture would take minutes."""
    generated("a.nrrd", size="200,200,200", sample_type="float")
    for script in ["quit", "wait 100\nquit", "set coarse off\nwait full\nwait 300\nquit"]:
        begin = time.monotonic()
        assert play(script, "a.nrrd", "--size", "1200x900").returncode == 0
        print(script.split()[-1], time.monotonic() - begin)
