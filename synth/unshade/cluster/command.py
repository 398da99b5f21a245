"""An order on a cluster, or on workers of this machine."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from typing import Any

from ..errors import ClusterError

_FIX = 'install it: pip install "unshade[cluster]"'


def on_cluster(
    request: dict[str, Any], address: str, store_url: str, workers: int, progress: Callable[[int, int, str], None]
) -> dict[str, Any]:
    """Does an order; returns the failures and the records of its stages."""
    try:
        import dask
        import distributed
    except ImportError as error:
        raise ClusterError(f"--cluster needs Dask ({error.name} is missing); {_FIX}") from error
    from .client import collect
    from .order import read_order
    from .store import Store

    order = read_order(request)
    own = store_url == str(order.run / "store")
    store = Store(store_url)
    if address != "local":
        result = collect(order, address, store, [], progress)
    else:
        # The disc of the run has room for its outputs.
        with (
            # Dask's own variables would change how much memory stages take.
            dask.config.set({"distributed.nanny.pre-spawn-environ": {}}),
            tempfile.TemporaryDirectory(prefix="workers.", dir=order.run, ignore_cleanup_errors=True) as place,
            distributed.LocalCluster(
                n_workers=workers, threads_per_worker=1, dashboard_address=None, memory_limit=0, scheduler_port=0,
                local_directory=place,
            ) as cluster,
        ):  # fmt: skip
            result = collect(order, cluster.scheduler_address, store, divided(processors(), workers), progress)
    if own:
        # All outputs are in the run now.
        store.remove()
    return result


def processors() -> list[int]:
    """The processors that this process may use."""
    return sorted(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else list(range(os.cpu_count() or 1))


def divided(processors: list[int], workers: int) -> list[list[int]]:
    """One equal part for each worker, at most one for each processor; further workers wait."""
    count = len(processors)
    parts = min(workers, count)
    return [processors[part * count // parts : (part + 1) * count // parts] for part in range(parts)]
