"""Functions compiled as a whole, ahead of their first call, and kept on disk.

XLA's code is kept by JAX itself. Here the traced program is kept too, in JAX's own portable
form, so that a later process need not trace it again: for a large program that takes as long
as all the rest. The name of a kept program holds what it depends on: the sources of this
package, the versions of JAX, and the structure and shapes of the arguments.
"""

from __future__ import annotations

import atexit
import contextlib
import hashlib
import os
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import Future
from functools import cache
from pathlib import Path
from typing import Any, Generic, ParamSpec, TypeVar

import equinox as eqx
import jaxlib.version
import numpy as np

from .._jax import jax

KEPT, TRACED = "/asperity/program/kept", "/asperity/program/traced"
"""Names under which JAX's monitoring is told of programs: found in their traced form, or traced."""

P = ParamSpec("P")
Answer = TypeVar("Answer")
Record = TypeVar("Record")

_OURS = f"{__package__.partition('.')[0]}."

HELD = 16
"""Compiled forms of one program that are kept in memory, those used last.

Each takes some 250 of the 65530 memory maps that Linux gives a process; one that runs out of
them dies. What is dropped is read from disk again.
"""

COMPILES = 2.0
"""Times the tracing of a program that compiling takes: 1.9 to 4 for a case on two cores."""

Options = dict[str, bool | int | str]
"""Options of XLA."""

QUICKLY: Options = {
    "xla_disable_hlo_passes": "while-loop-invariant-code-motion",
    "xla_cpu_use_fusion_emitters": False,
    "xla_backend_optimization_level": 1,
    "xla_cpu_parallel_codegen_split_count": 4,
}
"""Options of XLA for a third of the time to compile; a single motion runs as fast."""

AT_ONCE: Options = {**QUICKLY, "xla_backend_optimization_level": 0}
"""Options for a third less still, for what takes longer to compile than to run many times."""


def kept(record: type[Record]) -> type[Record]:
    """Register a named tuple that the answers of kept programs are made of."""
    name = f"{record.__module__}.{record.__qualname__}"
    jax.export.register_namedtuple_serialization(record, serialized_name=name)
    return record


class Program(Generic[P, Answer]):
    """A function of pytrees, compiled once for each structure and shape of its arguments.

    Arrays are traced; all else in the arguments is static and hashable, as the fields of an
    :class:`equinox.Module`. Called within another function that is traced, it is a part of that.

    Parameters
    ----------
    function
        A function that JAX can trace. Its answer is made of arrays, tuples and records that
        :func:`kept` knows.
    options
        XLA's options, but for those that ``XLA_FLAGS`` names in the environment.
    """

    def __init__(
        self,
        function: Callable[P, Answer],
        options: Options = QUICKLY,
    ) -> None:
        self._function = function
        flags = os.environ.get("XLA_FLAGS", "").split()
        asked = {flag.lstrip("-").partition("=")[0] for flag in flags}
        self._options = {name: value for name, value in options.items() if name not in asked}
        self._held: OrderedDict[Any, _Held] = OrderedDict()
        self._lock = threading.Lock()

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> Answer:
        leaves = jax.tree_util.tree_leaves((args, kwargs))
        if any(isinstance(leaf, jax.core.Tracer) for leaf in leaves):
            return self._function(*args, **kwargs)
        return self.ready(*args, **kwargs)()

    def ready(self, *args: P.args, **kwargs: P.kwargs) -> Callable[[], Answer]:
        """The call itself, once all is compiled that it needs."""
        fixed, arrays = _split((args, kwargs))
        compiled = self._of(fixed, arrays, aside=False).compiled.result()
        return lambda: compiled(arrays)

    def time_left(self, *args: Any) -> float:
        """About how long [s] such arguments wait for the compiler; 0 where it is through.

        It is compiled in a thread meanwhile. What was traced before is likely to be in JAX's
        cache too, and counts as compiled.
        """
        held = self._of(*_split((args, {})), aside=True)
        return 0.0 if held.compiled.done() else max(held.due - time.perf_counter(), 0.0)

    def ahead(self, *args: Any) -> Any:
        """Trace for such arguments and compile in a thread; the shapes of the answer.

        Shapes (:class:`jax.ShapeDtypeStruct`) serve as arguments.
        """
        return self._of(*_split((args, {})), aside=True).shapes

    def _of(self, fixed: Any, arrays: list[Any], *, aside: bool) -> _Held:
        key = fixed, tuple((x.shape, x.dtype) for x in arrays)
        with self._lock:
            held = self._held.get(key)
            if held is None:
                shapes = [jax.ShapeDtypeStruct(x.shape, x.dtype) for x in arrays]
                begun = time.perf_counter()
                lowered, traced = self._lowered(fixed, shapes, str(key))
                held = self._held[key] = _Held(lowered, begun if traced else None)
                if len(self._held) > HELD:
                    self._held.popitem(last=False)
            self._held.move_to_end(key)
            lowered, held.lowered = held.lowered, None
        if lowered is not None:
            if aside:
                thread = threading.Thread(target=held.make, args=(lowered,), daemon=True)
                _compiling.append(thread)
                thread.start()
            else:
                held.make(lowered)
        return held

    def _lowered(self, fixed: Any, shapes: list[Any], key: str) -> tuple[Any, bool]:
        """The program for XLA, read from disk or traced and written there; whether traced."""

        def function(arrays: list[Any]) -> Answer:
            args, kwargs = _join(fixed, arrays)
            return self._function(*args, **kwargs)

        traced = jax.jit(function, compiler_options=self._options)
        folder = _folder()
        ours = self._function.__module__.startswith(_OURS) and _all_ours(fixed[0])
        if folder is None or not ours:
            return traced.lower(shapes), True
        name = f"{self._function.__module__}.{self._function.__qualname__} {key}"
        file = folder / f"{hashlib.sha256((_ground() + name).encode()).hexdigest()}.jax"
        begun = time.perf_counter()
        exported = _read(file)
        told = TRACED if exported is None else KEPT
        if exported is None:
            exported = jax.export.export(traced)(shapes)
            _write(file, exported.serialize())
        jax.monitoring.record_event_duration_secs(told, time.perf_counter() - begun)
        lowered = jax.jit(exported.call, compiler_options=self._options).lower(shapes)
        return lowered, told == TRACED


_compiling: list[threading.Thread] = []


@atexit.register
def _finish() -> None:
    """Let XLA end what it compiles aside: an interpreter that ends before is aborted."""
    for thread in _compiling:
        thread.join()


class _Held:
    """One compiled form of a program.

    Parameters
    ----------
    lowered
        The program for XLA.
    begun
        When its tracing began [s]; None where it was kept.
    """

    def __init__(self, lowered: Any, begun: float | None) -> None:
        self.lowered = lowered
        now = time.perf_counter()
        self.due = now if begun is None else now + COMPILES * (now - begun)
        self.shapes = jax.tree_util.tree_map(
            lambda leaf: jax.ShapeDtypeStruct(leaf.shape, leaf.dtype), lowered.out_info
        )
        self.compiled: Future[Any] = Future()

    def make(self, lowered: Any) -> None:
        """Compile, and hand the outcome to whoever waits for it."""
        try:
            self.compiled.set_result(lowered.compile())
        except Exception as error:  # noqa: BLE001 - raised where the program is called
            self.compiled.set_exception(error)


def _is_traced(leaf: Any) -> bool:
    return eqx.is_array(leaf) or isinstance(leaf, jax.ShapeDtypeStruct | np.ndarray)


def _split(args: Any) -> tuple[Any, list[Any]]:
    """What is static of the arguments, hashable, and their arrays."""
    leaves, structure = jax.tree_util.tree_flatten(args)
    fixed = tuple(None if _is_traced(leaf) else (leaf,) for leaf in leaves)
    return (structure, fixed), [leaf for leaf in leaves if _is_traced(leaf)]


def _join(fixed: Any, arrays: list[Any]) -> Any:
    structure, kept = fixed
    rest = iter(arrays)
    leaves = [next(rest) if leaf is None else leaf[0] for leaf in kept]
    return jax.tree_util.tree_unflatten(structure, leaves)


def _all_ours(structure: Any) -> bool:
    """Whether the arguments are of this package alone: a user's own law changes unseen."""
    data = structure.node_data()
    if data is not None:
        kind = data[0]
        if kind not in (tuple, list, dict, type(None)) and not kind.__module__.startswith(_OURS):
            return False
    return all(_all_ours(child) for child in structure.children())


@cache
def _ground() -> str:
    """What every program depends on: these sources, and the versions of JAX."""
    digest = hashlib.sha256()
    root = Path(__file__).parents[1]  # the whole package
    for file in sorted(root.rglob("*.py")):
        digest.update(str(file.relative_to(root)).encode() + b"\0" + file.read_bytes() + b"\0")
    versions = jax.__version__, jaxlib.version.__version__, eqx.__version__
    return f"{digest.hexdigest()} {versions} {jax.default_backend()} "


def _folder() -> Path | None:
    """Beside JAX's own cache; None where that is off."""
    folder = jax.config.jax_compilation_cache_dir  # type: ignore[attr-defined]
    return Path(folder) / "programs" if folder else None


def _read(file: Path) -> Any:
    """A kept program; None where there is none, or one that is not whole."""
    try:
        content = file.read_bytes()
    except OSError:
        return None
    digest, program = content[:32], content[32:]
    if hashlib.sha256(program).digest() != digest:
        return None
    return jax.export.deserialize(bytearray(program))


def _write(file: Path, content: bytes | bytearray) -> None:
    """Written aside and renamed; a cache that cannot be written only costs time."""
    aside = file.with_suffix(f".{os.getpid()}.{threading.get_ident()}")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        aside.write_bytes(hashlib.sha256(content).digest() + content)
        aside.replace(file)
    except OSError:
        with contextlib.suppress(OSError):
            aside.unlink()
