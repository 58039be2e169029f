# SPDX-License-Identifier: BSD-3-Clause
"""Progress, Ctrl-C and threads."""
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import fresco
import numpy as np
import pytest


def test_progress_is_told_steps_and_fractions(sphere):
    heard = []
    fresco.reconstruct(sphere, progress=lambda step, fraction: heard.append((step, fraction)))
    assert len(heard) >= 2 and all(isinstance(step, str) and 0 <= fraction <= 1 for step, fraction in heard)


def test_false_from_progress_cancels(sphere):
    with pytest.raises(fresco.Cancelled):
        fresco.reconstruct(sphere, progress=lambda step, fraction: False)


def test_an_exception_of_progress_comes_out(sphere):
    class Mine(Exception):
        pass

    def fail(step, fraction):
        raise Mine(step)

    for call in (lambda: fresco.reconstruct(sphere, progress=fail), lambda: fresco.estimate_normals(sphere, progress=fail),
                 lambda: fresco.smooth_normals(sphere, progress=fail)):
        with pytest.raises(Mine):
            call()
    with pytest.raises(TypeError, match="positional"):
        fresco.reconstruct(sphere, progress=lambda: None)


SLOW = """
import fresco, numpy as np, sys
rows = np.random.default_rng(1).random((300000, 3), np.float32)
points = fresco.PointSet(rows, normals=rows)
print("begins", flush=True)
try:
    fresco.reconstruct(points, depth=10, iterations=1000)
except KeyboardInterrupt:
    sys.exit(42)
"""


def test_ctrl_c_ends_a_call():
    process = subprocess.Popen([sys.executable, "-c", SLOW], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begins\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=60) == 42


DAEMONS = """
import fresco, numpy as np, threading, time
points = fresco.PointSet(np.random.default_rng(1).random((20000, 3), np.float32))
begun = threading.Semaphore(0)
def work():
    def hear(step, fraction):
        begun.release()
        return sum(range(20000)) > 0
    while True:
        fresco.estimate_normals(points, progress=hear, threads=2)
for _ in range(6):
    threading.Thread(target=work, daemon=True).start()
for _ in range(20):
    begun.acquire()
"""


def test_python_ends_while_daemons_work():
    for _ in range(3):
        ended = subprocess.run([sys.executable, "-c", DAEMONS], stderr=subprocess.PIPE, text=True, timeout=60)
        assert (ended.returncode, ended.stderr) == (0, "")


def test_what_is_called_at_the_end_of_python_is_done(tmp_path):
    program = "import atexit; atexit.register(lambda: fresco.write_points(sys.argv[1], fresco.PointSet(np.zeros((1, 3)))))\n"
    subprocess.run([sys.executable, "-c", "import sys, numpy as np\n" + program + "import fresco\n", tmp_path / "last.ply"],
                   check=True, timeout=60)
    assert len(fresco.read_points(tmp_path / "last.ply").points) == 1


def test_the_gil_is_free_while_the_core_works(sphere):
    counted = 0
    done = threading.Event()

    def work():
        fresco.reconstruct(sphere, depth=7)
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not done.is_set():
        counted += 1
    thread.join()
    assert counted > 1000  # Python went on meanwhile


def test_four_threads_get_what_one_gets(sphere, tmp_path):
    def chain(i):
        field = fresco.estimate_normals(sphere)
        points = fresco.PointSet(sphere.points, normals=fresco.smooth_normals(sphere, sphere.normals).normals)
        mesh = fresco.reconstruct(points, depth=5).mesh
        fresco.write_mesh(tmp_path / f"mesh_{i}.ply", mesh)
        picture = fresco.snapshot(mesh, width=160, height=120)
        return field.normals, mesh.vertices, fresco.read_mesh(tmp_path / f"mesh_{i}.ply").faces, picture

    one = chain(4)
    with ThreadPoolExecutor(4) as pool:
        for result in pool.map(chain, range(4)):
            assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, result))


def test_an_attribute_may_be_replaced_while_a_call_uses_it(sphere):
    points = fresco.PointSet(sphere.points.copy(), normals=sphere.normals.copy())
    wanted = fresco.reconstruct(points, depth=6).mesh.vertices

    def replace(step, fraction):
        points.points = np.zeros((1, 3), np.float32)
        points.normals = None

    assert np.array_equal(fresco.reconstruct(points, depth=6, progress=replace).mesh.vertices, wanted)


def test_a_forked_process_goes_on(sphere):
    fresco.estimate_normals(sphere)  # the threads of the core are there
    child = os.fork()
    if child == 0:
        os._exit(0 if np.isfinite(fresco.estimate_normals(sphere).normals).all() else 1)
    assert os.waitpid(child, 0)[1] == 0
