"""Campaigns on Dask: the same bits, sockets on 127.0.0.1 only, killed workers, clusters that are gone."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import psutil
import pytest
from campaign_files import BODY, same, spin
from killed_workers import check_killed_workers, check_random_kills, number_of_cases

import onorbit_rs as oo
from onorbit_rs.campaigns import on_dask
from onorbit_rs.exceptions import CampaignError, InputError

distributed = pytest.importorskip("distributed", reason="Dask is not installed")
pytestmark = [
    pytest.mark.usefixtures("no_campaign_report"),
    pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]


def tree() -> list[psutil.Process]:
    return [psutil.Process(), *psutil.Process().children(recursive=True)]


def listening() -> set[str]:
    """Returns the addresses at which this process and its children accept connections."""
    found = set()
    for process in tree():
        try:
            found |= {one.laddr.ip for one in process.net_connections() if one.status == psutil.CONN_LISTEN}
        except psutil.Error:  # it has just ended
            continue
    return found


@pytest.fixture(scope="module")
def cluster() -> Iterator[str]:
    from dask import config

    with (
        config.set(on_dask._SETTINGS),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0",
            memory_limit=0,
        ) as found,
    ):  # fmt: skip
        yield found.scheduler_address


def test_a_cluster_gives_the_bits_of_threads(cluster: str, tmp_path: Path) -> None:
    campaign = spin(keep={"columns": ["v"]})
    found = oo.campaign(campaign, tmp_path, cluster=cluster)
    assert same(found).equals(same(oo.campaign(campaign)))
    assert (tmp_path / "columns.parquet").exists()


def test_killed_workers_lose_no_case_and_repeat_none(
    cluster: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("onorbit_rs.campaigns.on_dask._BATCH_S", 0.05)
    check_killed_workers(
        tmp_path,
        number_of_cases(12),
        lambda campaign: oo.campaign(campaign, tmp_path / "out", cluster=cluster),
        monkeypatch,
    )


def test_workers_killed_at_random_lose_no_case(
    cluster: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def workers() -> list[psutil.Process]:
        return [one for one in psutil.Process().children() if "spawn_main" in " ".join(one.cmdline())]

    check_random_kills(
        tmp_path,
        number_of_cases(30),
        lambda campaign: oo.campaign(campaign, tmp_path / "out", cluster=cluster),
        workers,
        monkeypatch,
    )


def test_a_local_cluster_listens_on_this_machine_only(monkeypatch: pytest.MonkeyPatch) -> None:
    before, during = listening(), set()
    from onorbit_rs.campaigns import on_dask

    original = on_dask._Tasks._next

    def watched(self: Any) -> Any:
        during.update(listening())
        return original(self)

    monkeypatch.setattr(on_dask._Tasks, "_next", watched)
    campaign = spin(4)
    found = oo.campaign(campaign, cluster="local", workers=1)
    assert during == {"127.0.0.1"}
    assert same(found).equals(same(oo.campaign(campaign)))
    assert listening() == before, "the cluster has ended"


def test_no_port_is_open_without_a_cluster(monkeypatch: pytest.MonkeyPatch) -> None:
    before = listening()
    found: list[set[str]] = []
    from onorbit_rs.campaigns import run as campaign_run

    original = campaign_run._complete

    def watched(plan: Any, outcomes: Any) -> Any:
        found.append(listening())
        return original(plan, outcomes)

    monkeypatch.setattr(campaign_run, "_complete", watched)
    monkeypatch.setattr(campaign_run, "on_threads", campaign_run.on_processes)
    oo.campaign(spin(2), workers=1)
    assert found == [before]


def test_a_cluster_that_does_not_answer_is_an_error(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("onorbit_rs.campaigns.on_dask._CONNECT_S", 0.3)
    with pytest.raises(CampaignError, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:9") as caught:
        oo.campaign(spin(), tmp_path, cluster="tcp://127.0.0.1:9")
    assert caught.value.reason == "no cluster"
    assert oo.campaign(spin(), tmp_path).num_rows == 8


def test_a_cluster_that_disappears_keeps_the_cases(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = """
import sys, time
from distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as cluster:
        print(cluster.scheduler_address, flush=True)
        time.sleep(600)
"""
    (tmp_path / "cluster.py").write_text(program)
    monkeypatch.setattr("onorbit_rs.campaigns.on_dask._LOST_S", 1.0)
    monkeypatch.setattr("onorbit_rs.campaigns.storage._EVERY_S", 0.0)
    process = subprocess.Popen(
        [sys.executable, "cluster.py"], cwd=tmp_path, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    address = process.stdout.readline().strip()
    children = psutil.Process(process.pid).children(recursive=True)
    campaign = spin(500)
    campaign["campaign"]["scenario"] = BODY | {"simulation": {"duration": 4.0, "time_step": 1e-3}}
    out = tmp_path / "out"

    def end() -> None:
        while not list(out.glob("cases/part-*.json")):
            time.sleep(0.02)
        for one in [process, *children]:
            one.kill()

    killer = threading.Thread(target=end)
    killer.start()
    with pytest.raises(
        CampaignError, match=r"was lost; check that its scheduler is running; \d+ of 500 cases (is|are) kept"
    ):
        oo.campaign(campaign, out, cluster=address)
    killer.join()
    process.wait()


def test_a_cluster_without_workers_is_an_error_that_keeps_the_cases(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The campaign once waited forever for the tasks of a cluster whose workers had all ended."""
    monkeypatch.setattr("onorbit_rs.campaigns.on_dask._BATCH_S", 0.05)
    campaign = spin(200)
    out = tmp_path / "out"
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address=None, memory_limit=0
    ) as cluster:
        original = on_dask._Tasks._results

        def end_workers(self: Any, future: Any, cases: list[int]) -> Any:
            found = original(self, future, cases)
            if any(case > 20 for case in cases):
                monkeypatch.setattr("onorbit_rs.campaigns.on_dask._WITHOUT_WORKERS_S", 1.5)
                cluster.scale(0)
            return found

        with monkeypatch.context() as patched:
            patched.setattr(on_dask._Tasks, "_results", end_workers)
            words = r"has lost all of its workers, .* for 1\.5 s; .*\d+ of 200 cases are kept"
            with pytest.raises(CampaignError, match=words) as caught:
                oo.campaign(campaign, out, cluster=cluster.scheduler_address)
    assert caught.value.reason == "no workers"
    assert same(oo.campaign(campaign, out)).equals(same(oo.campaign(campaign)))


def test_a_worker_with_another_version_is_refused(cluster: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("onorbit_rs.campaigns.plan.software", lambda: "onorbit_rs 0.0.1, avx2")
    with pytest.raises(
        CampaignError, match=r"but the campaign was started with onorbit_rs 0\.0\.1"
    ) as caught:
        oo.campaign(spin(), cluster=cluster)
    assert caught.value.reason == "version"


def test_dask_is_needed_for_a_cluster(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match="pip install 'onorbit-rs"):
        oo.campaign(spin(), cluster="local")


@pytest.mark.parametrize("status", ["running", "closed"])
def test_a_transfer_that_is_cut_off_is_tried_again(status: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(on_dask, "_RETRY_S", 0.0)
    calls = []

    def result(timeout: float) -> str:
        calls.append(timeout)
        if len(calls) < 3:
            raise distributed.comm.CommClosedError
        return "outcome"

    tasks = object.__new__(on_dask._Tasks)
    tasks._client = SimpleNamespace(status=status, nthreads=lambda: {"tcp://y": 1})
    tasks._address, tasks._lost_since = "tcp://x", None
    future = SimpleNamespace(result=result)
    if status == "running":
        assert tasks._result(future) == "outcome" and len(calls) == 3
    else:
        with pytest.raises(CampaignError, match="was lost; check that its scheduler is running"):
            tasks._result(future)
