# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C and progress."""
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import lamina

# Its trace takes minutes.
LONG = {"version": 1, "volume": {"generate": "mixing", "size": [64, 64, 64]}, "image": {"width": 2000, "height": 1500},
        "render": {"trace": {"tolerance": 1e-9}}}


def test_control_c_ends_a_picture():
    session = lamina.Session(LONG, context="cpu")
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        session.trace()
    timer.join()
    # The next picture is drawn from the start.
    session.size = (16, 12)
    assert session.draw().array.max() > 0


def test_control_c_ends_a_session_that_reads_its_data():
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        lamina.Session({"version": 1, "volume": {"generate": "mixing", "size": [512, 512, 512]}})  # takes 10 s
    assert time.monotonic() - begin < 30
    timer.join()


def test_control_c_ends_a_program():
    code = ("import lamina, sys\n"
            "session = lamina.Session(" + repr(LONG) + ")\n"
            "print('begins', flush=True)\n"
            "session.trace()\n")
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "begins\n"
        time.sleep(0.3)
        child.send_signal(signal.SIGINT)
        _, said = child.communicate(timeout=60)
    assert child.returncode == -signal.SIGINT and said.rstrip().endswith("KeyboardInterrupt")


def test_progress_is_heard():
    heard = []
    picture = lamina.trace(LONG, size=(160, 120), trace={"tolerance": 1e-5},
                           progress=lambda activity, share: heard.append((activity, share)))
    assert picture.array.max() > 0 and heard
    shares = [share for _, share in heard]
    assert all(isinstance(activity, str) and activity for activity, _ in heard)
    assert all(0 <= share <= 1 for share in shares) and shares == sorted(shares)


def test_an_exception_of_progress_stops():
    def enough(activity, share):
        raise ArithmeticError("enough")
    with pytest.raises(ArithmeticError, match="enough"):
        lamina.trace(LONG, progress=enough)


def test_other_threads_run_meanwhile():
    counted, ended = [0], threading.Event()

    def count():
        while not ended.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    lamina.trace(LONG, size=(200, 150), trace={"tolerance": 1e-5})
    during = counted[0] - before
    ended.set()
    thread.join()
    assert during > 3
