# SPDX-License-Identifier: MIT
"""Jobs, interruptions, threads and processes."""

from __future__ import annotations

import concurrent.futures
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
from conftest import bowl_of, torus_of

import taut


def test_a_job_ends_with_the_result(bowl):
    job = taut.start(taut.unwrap, *bowl)
    assert job.result(60).certified and job.done


def test_a_job_raises_what_its_call_raises(torus):
    with pytest.raises(taut.MeshError):
        taut.start(taut.unwrap, *torus).result(60)


def test_a_job_is_cancelled_with_the_best_result(large_bowl):
    job = taut.start(taut.unwrap, *large_bowl, tolerance=1e-14, energy=lambda s: s.S.norm2() * (1 + 1 / s.J**2) ** 3)
    with pytest.raises(TimeoutError):
        job.result(0.01)
    while not job.done and not job.progress.usable:
        time.sleep(0.01)
    start = time.monotonic()
    job.cancel()
    try:
        assert job.result(10).certified  # it had just ended
    except taut.Cancelled as e:
        assert e.best is None or e.best.certified
    assert time.monotonic() - start < 1.0


def test_two_jobs_run_at_a_time(bowl):
    jobs = [taut.start(taut.unwrap, *bowl), taut.start(taut.atlas, *bowl), taut.start(taut.unwrap, *bowl)]
    a, b, c = (j.result(60) for j in jobs)
    assert np.array_equal(a.uv, c.uv) and b.charts >= 1


def test_threads_of_the_user_may_call(bowl):
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        maps = list(pool.map(lambda _: taut.unwrap(*bowl).uv, range(6)))
    assert all(np.array_equal(m, maps[0]) for m in maps)


def interrupt_after(seconds):
    """A timer to start where the interrupt is expected: `start` waits for its thread, which may take longer."""
    return threading.Timer(seconds, lambda: os.kill(os.getpid(), signal.SIGINT))


MOMENTS = np.linspace(0.001, 0.4, 50) if os.environ.get("TAUT_LONG_TESTS") else [0.002, 0.02, 0.06, 0.15, 0.3]


@pytest.mark.parametrize("moment", MOMENTS)
def test_ctrl_c_ends_a_call_soon_and_leaves_all_as_it_was(large_bowl, moment):
    start = time.monotonic()
    timer = interrupt_after(moment)
    try:
        timer.start()
        while True:
            taut.unwrap(*large_bowl, tolerance=1e-14)
    except taut.Interrupted as e:
        assert e.best is None or taut.certify(large_bowl[1], e.best.uv)
        assert isinstance(e, KeyboardInterrupt)
    except KeyboardInterrupt:
        pass  # between two calls
    assert time.monotonic() - start < moment + 1.0
    timer.join()
    V, F = bowl_of(8)
    assert taut.unwrap(V, F).certified


def test_ctrl_c_during_an_atlas_of_a_rough_surface_has_a_result():
    V, F = torus_of(200, 100)
    V += np.random.default_rng(0).normal(0, 0.012, V.shape)
    start = time.monotonic()
    timer = interrupt_after(0.15)
    timer.start()
    with pytest.raises(taut.Interrupted) as e:
        while True:
            taut.atlas(V, F)
    assert time.monotonic() - start < 0.15 + 1.0
    timer.join()
    made = e.value.best  # waits where the work had not ended yet
    assert len(made.faces) == len(F) and not made.complete
    assert len(taut.certify(made.faces, made.uv).flipped) == 0


def test_the_best_result_of_work_that_is_left_alone_is_waited_for_once():
    asked = []
    for kind in (taut.Interrupted, taut.Cancelled):
        e = kind("ended", later=lambda: asked.append(1) or "best")
        copied = pickle.loads(pickle.dumps(kind("ended", best=7, later=lambda: "not copied")))
        assert e.best == e.best == "best" and copied.best == 7 and str(copied) == "ended"
    assert len(asked) == 2


def test_a_handler_of_another_signal_may_raise(large_bowl):
    def late(number, frame):
        raise TimeoutError("an alarm")

    old = signal.signal(signal.SIGALRM, late)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        with pytest.raises(TimeoutError, match="an alarm"):
            while True:
                taut.unwrap(*large_bowl, tolerance=1e-14)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, old)


def test_other_threads_go_on_during_a_call(large_bowl):
    ticks, stop = [], threading.Event()

    def tick():
        while not stop.wait(0.005):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.monotonic()
    taut.unwrap(*large_bowl, tolerance=1e-9)
    end = time.monotonic()
    stop.set()
    thread.join()
    inside = [t for t in ticks if start < t < end]
    longest = max(b - a for a, b in zip([start] + inside, inside + [end]))
    assert longest < 0.3


def run_python(code, **environment):
    folder = os.path.dirname(os.path.dirname(os.path.abspath(taut.__file__)))
    return subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=120,
                          env={**os.environ, "PYTHONPATH": folder, **environment})


def test_a_forked_child_gets_a_sentence():
    done = run_python("""
        import os, taut
        taut.unwrap([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        if os.fork() == 0:
            try:
                taut.unwrap([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
            except taut.DeviceError as e:
                print("spawn" in str(e) and "fork" in str(e), flush=True)
            os._exit(0)
        os.wait()
    """)
    assert done.stdout.strip() == "True", done.stderr


def test_functions_are_pickled_and_run_by_spawn(bowl):
    for function in (taut.unwrap, taut.atlas, taut.deform, taut.repair):
        assert pickle.loads(pickle.dumps(function)) is function
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=context) as pool:
        made = pool.submit(taut.unwrap, *bowl).result(120)
        assert np.array_equal(made.uv, taut.unwrap(*bowl).uv)
        with pytest.raises(taut.ParameterError) as e:
            pool.submit(taut.unwrap, bowl[0], bowl[1] + 10**6).result(120)
        assert e.value.field == "F"


def test_the_first_calls_of_a_process_may_be_made_at_a_time():
    done = run_python("""
        import concurrent.futures, taut
        V, F = [[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]]
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            print(all(pool.map(lambda _: taut.unwrap(V, F).certified, range(4))))
    """)
    assert done.stdout.strip() == "True", done.stderr


def test_without_a_driver_the_host_computes(tmp_path):
    done = run_python("""
        import taut
        from taut import _drivers
        _drivers.drivers_by_pip = lambda: []  # as where pip has brought none
        print([d.kind for d in taut.devices()])
        print(taut.unwrap([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).certified)
        try:
            taut.unwrap([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], device="pthread")
        except taut.DeviceError as e:
            print("pthread" in str(e))
    """, OCL_ICD_VENDORS=str(tmp_path), OCL_ICD_FILENAMES="")
    assert done.stdout.splitlines() == ["['host']", "True", "True"], done.stderr



def test_the_interpreter_ends_well_in_the_middle_of_a_call():
    done = run_python("""
        import numpy as np, sys, taut, time
        sys.path.insert(0, %r)
        from conftest import bowl_of
        job = taut.start(taut.unwrap, *bowl_of(200), tolerance=1e-14)
        time.sleep(0.3)
    """ % os.path.dirname(os.path.abspath(__file__)))
    assert done.returncode == 0, done.stderr


def test_arguments_are_named_as_python_has_them(bowl):
    with pytest.raises(taut.ParameterError, match="^energy: "):
        taut.unwrap(*bowl, energy="slim")
    with pytest.raises(taut.ParameterError, match="^progress: is 3"):
        taut.unwrap(*bowl, progress=3)


def test_whole_numbers_may_be_floats(bowl):
    made = taut.atlas(*bowl, resolution=512.0, padding=np.float32(4))
    assert (made.uv == taut.atlas(*bowl, resolution=512, padding=4).uv).all()
    with pytest.raises(taut.ParameterError, match="resolution: is 512.5"):
        taut.atlas(*bowl, resolution=512.5)


def test_arguments_that_would_have_no_effect_or_are_of_another_kind_are_refused(bowl):
    V, F = bowl
    m, flat = len(F), V[:, :2]
    session = taut.Session(V, F)
    for field, call in [
        ("attributes", lambda: taut.unwrap(V, F, attributes=np.ones(m))),
        ("directions", lambda: taut.unwrap(V, F, directions=V[F[:, 0]])),
        ("parameters", lambda: taut.unwrap(V, F, parameters=[1.0])),
        ("placement", lambda: taut.unwrap(V, F, b=[0, 1], bc=flat[:2], placement="unit_square")),
        ("bc", lambda: taut.unwrap(V, F, b=[0, 1], bc=[[0.0, 0.0], [np.nan, np.nan]])),
        ("weights", lambda: taut.unwrap(V, F, weights=np.linspace(1, 2, len(F)) * 1e160)),
        ("weights", lambda: taut.unwrap(V, F, weights=np.full(len(F), 1e-160))),
        ("x", lambda: taut.Session(V, F).pin(0, [np.nan, np.nan])),
        ("placement", lambda: taut.unwrap(V, F, springs=([0], flat[:1], 1), placement="unit_square")),
        ("boundary", lambda: taut.unwrap(V, F, boundary="circle", initial=flat)),
        ("kind", lambda: taut.Session(V, F, kind=["map"])),
        ("S", lambda: taut.energies.isometric.value([[1, 0, 0]])),
        ("poisson", lambda: taut.energies.neo_hookean("a")),
        ("poisson", lambda: taut.energies.neo_hookean(0.5)),
        ("vertices", lambda: taut.cortex.write_patch("nowhere.patch", [1, 1], [[0, 0], [1, 1]])),
        ("cut", lambda: taut.grids.flatten(np.ones((3, 3, 3)) * np.arange(3)[:, None], cut=np.array([True, False]))),
        ("grid", lambda: taut.grids.steps([1, 2])),
        ("max_stretch", lambda: taut.atlas(V, F, max_stretch="a")),
        ("springs", lambda: taut.unwrap(V, F, springs=([0, 1], flat[:2], [1, 0]))),
        ("rest", lambda: taut.smooth(flat, F, rest=flat)),
        ("faces", lambda: taut.paste((V, F), (V, F), 0, at=0, radius=0.1, faces=[0])),
        ("grain", lambda: taut.patterns.pieces(V, F, grain=V[F[:, 0]])),
        ("slides", lambda: taut.deform(flat, F, slides=5)),
        ("C", lambda: taut.deform(flat, [5])),
        ("tiles", lambda: taut.pack(flat, F, tiles="a")),
        ("snapshot", lambda: session.restore((1, 2))),
        ("timeout", lambda: taut.start(taut.certify, F, flat).result(timeout="a")),
    ]:
        with pytest.raises(taut.ParameterError) as e:
            call()
        assert e.value.field == field
    assert taut.unwrap(V, F, holes=np.True_, single=np.True_).certified
    assert taut.repair(V, F, weld=np.True_).F.shape == F.shape


def test_a_result_that_is_waited_for_is_the_same_for_all_threads():
    from taut import _call

    left = [object()]

    def later():
        time.sleep(0.05)
        return {"x": left.pop()}

    with pytest.raises(taut.Cancelled) as told:
        _call.conclude(("cancelled", None, later), lambda d: d["x"])
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda _: told.value.best, range(4)))
    assert found[0] is not None and all(f is found[0] for f in found) and told.value.best is found[0]


def test_a_map_of_singles_keeps_pins_that_are_singles(bowl):
    V, F = bowl
    made = taut.unwrap(V, F, single=True, b=[0, 16], bc=[[0.1, 0.2], [1.7, 0.3]])
    assert (made.uv == made.uv.astype(np.float32)).all() and taut.certify(F, made.uv)
    assert (made.uv[[0, 16]] == np.float32([[0.1, 0.2], [1.7, 0.3]])).all()
    polygons = np.repeat(np.arange(len(F) // 2), 2)
    assert len(taut.unwrap(V, F, single=True, polygons=polygons, no_overlap=True).report["concave"]) == 0
    with pytest.raises(taut.Infeasible, match="all vertices pinned, flipped or flat"):
        taut.unwrap([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], single=True, b=[0, 1, 2],
                    bc=[[1e6, 1e6], [1e6 + 1e-4, 1e6], [1e6, 1e6 + 1e-4]])
