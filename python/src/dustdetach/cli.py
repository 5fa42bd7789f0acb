"""The command ``dustdetach``: a thin layer over the library.

Exit status: 0 done; 1 something is missing or some cases failed; 2 bad input, one line on standard error, nothing
written; 130 interrupted.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from io import TextIOWrapper
from pathlib import Path
from typing import NoReturn, TypeAlias

from .cases import NAMED, named_or_file, with_methods
from .errors import DustError, InvalidInput, one_line
from .files import writable_file
from .impact import (
    BARE_FROM_GEOMETRY,
    METHODS,
    PARAMETER_TYPES,
    RINGING,
    TANGENTIAL,
    TIMESTEP_FROM_CONTACT,
    Impact,
    option,
)
from .result import Result
from .version import __version__

# what an option's help says; the ranges are those of Impact
_HELP = {
    "speed": "impact speed, m/s",
    "angle": "between velocity and wall, degrees; 90 is straight",
    "restitution": "coefficient of restitution of carrier and wall",
    "coverage": "X0, grain cross-sections over the carrier's surface",
    "bare": "half-angle of the bare cap, rad (so wide that no grain reaches the wall: 0.33 in the reference case)",
    "grain_diameter": "m",
    "carrier_diameter": "m",
    "hamaker": "A_12 of grain and carrier, J; that of two grains stays at 10.1e-20 in a resolved run",
    "z0": "separation at which van der Waals force and pull-off force are equal, m",
    "spread": "geometric standard deviation of the grains' pull-off forces; 1: all alike",
    "friction": "mu_f of grain and carrier",
    "wall_friction": "mu of carrier and wall",
    "grain_damping": "damping ratio of a grain's contact; resolved runs and --tangential " + " or ".join(RINGING),
    "seed": "of the random texture",
    "tangential": "tangential lift-off: " + ", ".join(TANGENTIAL),
    "timestep": "s (a share of the contact time, 1/300 in general; 1e-9 in a resolved run)",
}
_Commands: TypeAlias = "argparse._SubParsersAction[_Parser]"
_TEXTURE = ("coverage", "bare", "grain_diameter", "carrier_diameter", "spread", "seed")


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {one_line(message)}\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command.

    Args:
        arguments: without the program's name; the process's own if ``None``.

    Returns:
        The exit status.
    """
    if isinstance(sys.stdout, TextIOWrapper):
        # file names need not be text
        sys.stdout.reconfigure(errors="surrogateescape")
    options = _parser().parse_args(arguments)
    speaks = _rank() == 0
    try:
        if _ranks() > 1 and getattr(options, "executor", "local") != "mpi":
            raise InvalidInput(f"started on {_ranks()} MPI ranks; allowed: sweep with --executor mpi, or no mpirun")
        status: int = options.run(options, speaks)
        sys.stdout.flush()
        return status
    except DustError as error:
        if speaks:
            print(f"{options.program}: {error}", file=sys.stderr)
        return error.status
    except KeyboardInterrupt:
        print(f"{options.program}: interrupted", file=sys.stderr)
        return 130
    except BrokenPipeError:
        _drop_output()
        return 1
    except (OSError, MemoryError) as error:
        # a full disk behind standard output, or what else the machine cannot do
        print(f"{options.program}: {one_line(_said_of_machine(error))}", file=sys.stderr)
        _drop_output()
        return 1


def _said_of_machine(error: OSError | MemoryError) -> str:
    if isinstance(error, MemoryError):
        return f"not enough memory {error}".rstrip()
    # files say their names, what is printed has none
    return f"{error.filename or 'standard output'}: {error.strerror or error}"


def _drop_output() -> None:
    """What standard output still holds goes nowhere: Python would complain about it at the end."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="dustdetach", description="Dust detachment from carrier particles that hit a wall.")
    parser.add_argument("--version", action="version", version=f"dustdetach {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    impact = _command(commands, "impact", "one impact", _impact)
    impact.add_argument("--method", default=argparse.SUPPRESS, help=", ".join(METHODS) + f" ({Impact.method})")
    for name in _HELP:
        _add_parameter(impact, name, required=name == "speed")
    impact.add_argument(
        "--rotation",
        action=argparse.BooleanOptionalAction,
        default=argparse.SUPPRESS,
        help="whether the functions follow the carrier's spin; resolved runs always do (--rotation)",
    )
    impact.add_argument("--json", action="store_true", help="print one JSON object")
    impact.add_argument(
        "--picture", type=Path, metavar="PNG", help="draw the carrier after the impact; four moments of a resolved one"
    )

    sweep = _command(commands, "sweep", "many impacts into a folder; picks up where it stopped", _sweep)
    sweep.add_argument("cases", metavar="|".join(NAMED) + "|FILE.toml", help="a figure of the paper, or a TOML file")
    sweep.add_argument("--method", help=", ".join(METHODS) + f", both (as the cases say, else {Impact.method})")
    sweep.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder of the results")
    sweep.add_argument("--jobs", type=int, default=1, metavar="N", help="processes (1)")
    sweep.add_argument("--executor", default="local", help="local, or mpi under mpirun (local)")

    plot = _command(commands, "plot", "figures of a sweep as PNG and SVG", _plot)
    plot.add_argument("folder", type=Path, metavar="DIR", help="folder of a sweep")

    texture = commands.add_parser("texture", help="make, check or draw a texture", description="Textures of grains.")
    textures = texture.add_subparsers(required=True, metavar="COMMAND")
    make = _command(textures, "make", "place grains on a carrier and write them to a file", _texture_make)
    for name in _TEXTURE:
        _add_parameter(make, name, required=False)
    make.add_argument(
        "--distribution",
        nargs=3,
        metavar=("KIND", "X50", "SPREAD"),
        help="of sizes by volume: lognormal, median (m) and geometric standard deviation, or rrsb, median and exponent",
    )
    make.add_argument("--out", type=Path, required=True, metavar="FILE", help="texture file")
    make.add_argument("--picture", type=Path, metavar="PNG", help="draw it, too")
    check = _command(textures, "check", "check a texture file", _texture_check)
    check.add_argument("file", type=Path, metavar="FILE", help="texture file")
    draw = _command(textures, "draw", "draw a carrier with its grains", _texture_draw)
    draw.add_argument("file", type=Path, metavar="FILE", help="texture file")
    draw.add_argument("--out", type=Path, required=True, metavar="PNG", help="picture")

    _command(commands, "doctor", "what is installed, and what is wrong with it", _doctor)
    report = _command(commands, "report", "not there yet", _report)
    report.add_argument("folder", type=Path, metavar="DIR", help="folder of a sweep")
    return parser


def _command(commands: _Commands, name: str, text: str, run: Callable[[argparse.Namespace, bool], int]) -> _Parser:
    parser = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".", allow_abbrev=False)
    parser.set_defaults(run=run, program=parser.prog)
    return parser


def _add_parameter(parser: argparse.ArgumentParser, name: str, *, required: bool) -> None:
    kind = {"float": float, "int": int, "str": str}[PARAMETER_TYPES[name]]
    default = getattr(Impact, name, None)
    if default is BARE_FROM_GEOMETRY or default is TIMESTEP_FROM_CONTACT:
        default = None
    parser.add_argument(
        option(name),
        type=kind,
        required=required,
        default=argparse.SUPPRESS,
        metavar="WORD" if kind is str else "N" if kind is int else "X",
        help=_HELP[name] + ("" if default is None else f" ({default:g})" if kind is not str else f" ({default})"),
    )


def _given(options: argparse.Namespace, names: Sequence[str]) -> dict[str, object]:
    return {name: getattr(options, name) for name in names if hasattr(options, name)}


def _impact(options: argparse.Namespace, _: bool) -> int:
    impact = Impact.from_mapping(_given(options, ("method", *_HELP, "rotation")))
    if options.picture is None:
        from .runner import run

        result = run(impact, watch=_watch())
    else:
        from .pictures import draw_impact

        result = draw_impact(impact, _png(options.picture, "--picture"), _watch())
    print(result.to_json() if options.json else _summary(result))
    return 0


class _StatusLine:
    """A line on standard error: rewritten on a terminal, else a new one for each mark."""

    def __init__(self) -> None:
        self.terminal = sys.stderr.isatty()
        self._mark = 0

    def tell(self, line: str, mark: int, end: str = "") -> None:
        """Show the line; ``mark`` counts what is worth a line of its own, ``end`` is what follows on a terminal."""
        if self.terminal:
            print(f"\r{line}\033[K", end=end, file=sys.stderr, flush=True)
        elif mark != self._mark:
            print(line, file=sys.stderr, flush=True)
            self._mark = mark


def _watch() -> Callable[[float], None]:
    """Simulated time, off a terminal every 10 us."""
    line = _StatusLine()
    digits = 1 if line.terminal else 0
    return lambda seconds: line.tell(f"{seconds * 1e6:.{digits}f} us", int(seconds * 1e6 // 10), end="\r")


def _summary(result: Result) -> str:
    modes = []
    if result.normal is not None and result.tangential_mode is not None:
        modes = [f"  by lift-off      normal {result.normal:.4f}   tangential {result.tangential_mode:.4f}"]
    return "\n".join(
        [
            f"impact at {result.speed:g} m/s, {result.angle:g} degrees, restitution {result.restitution:g}, "
            f"{result.grains} grains",
            f"dispersion ratio   {result.dispersion_ratio:.4f}",
            f"  by hemisphere    south {result.south:.4f}   north {result.north:.4f}",
            *modes,
            f"collision          {result.contact_time * 1e6:.3f} us, peak acceleration "
            f"{result.peak_acceleration:.4g} m/s2, restitution {result.restitution_realised:.4f}",
            f"ended by {result.end} after {result.steps} steps, {result.wall_seconds:.2f} s",
        ]
    )


def _sweep(options: argparse.Namespace, speaks: bool) -> int:
    from .sweeping import CasesFailed, sweep

    cases = with_methods(named_or_file(options.cases), options.method)
    progress = _progress() if speaks else None
    try:
        sweep(cases, options.out, jobs=options.jobs, executor=options.executor, progress=progress)
    except CasesFailed as error:
        if speaks:
            for case, message in error.failures:
                where = f"speed {case.speed:g}, angle {case.angle:g}, restitution {case.restitution:g}"
                print(f"dustdetach sweep: case failed ({where}): {message}", file=sys.stderr)
        return 1
    if speaks:
        print(options.out / "results.csv")
    return 0


def _progress() -> Callable[[int, int, float], None]:
    """Cases done and time left, off a terminal at the start and at each tenth of the way."""
    line = _StatusLine()

    def tell(done: int, total: int, left: float) -> None:
        # marks from 1: the start is one
        line.tell(
            f"{done}/{total} cases, {left:.0f} s left", 1 + 10 * done // max(total, 1), "\n" if done == total else ""
        )

    return tell


def _plot(options: argparse.Namespace, _: bool) -> int:
    from .figures import plot

    for path in plot(options.folder):
        print(path)
    return 0


def _texture_make(options: argparse.Namespace, _: bool) -> int:
    from .texture import Distribution, make_texture, read_texture

    distribution = None
    if options.distribution:
        kind, *numbers = options.distribution
        try:
            median, spread = map(float, numbers)
        except ValueError:
            raise InvalidInput(f"--distribution: {' '.join(numbers)}: not two numbers") from None
        distribution = Distribution(kind, median, spread)
    # the speed of the impact does not matter to its texture
    impact = Impact.from_mapping({"speed": 1.0, **_given(options, _TEXTURE)})
    out = writable_file(options.out, "--out")
    picture = _png(options.picture, "--picture") if options.picture else None
    make_texture(impact, out, distribution)
    texture = read_texture(out)
    if picture:
        from .pictures import draw_texture

        draw_texture(texture, picture)
    print(f"{out}: {len(texture.diameters)} grains, coverage {texture.coverage:.6f}")
    return 0


def _texture_check(options: argparse.Namespace, _: bool) -> int:
    from .texture import read_texture

    texture = read_texture(options.file)
    print(
        f"{options.file}: {len(texture.diameters)} grains, coverage {texture.coverage:.6f}, bare cap "
        f"{texture.bare:g} rad; unit vectors, no overlaps, none in the bare cap"
    )
    return 0


def _texture_draw(options: argparse.Namespace, _: bool) -> int:
    from .pictures import draw_texture
    from .texture import read_texture

    draw_texture(read_texture(options.file), _png(options.out, "--out"))
    print(options.out)
    return 0


def _png(path: Path, name: str) -> Path:
    if path.suffix.lower() != ".png":
        raise InvalidInput(f"{name}: {path}; allowed: a file name that ends in .png")
    return writable_file(path, name)


def _doctor(_: argparse.Namespace, __: bool) -> int:
    from .doctor import examine

    findings = examine()
    for finding in findings:
        print(f"{'  ok ' if finding.ok else 'WRONG'}  {finding.what}: {finding.found}")
    return 0 if all(finding.ok for finding in findings) else 1


def _report(_: argparse.Namespace, __: bool) -> int:
    raise InvalidInput("report is not there yet; allowed: plot")


def _rank() -> int:
    return _environment_number(("OMPI_COMM_WORLD_RANK", "PMI_RANK"), 0)


def _ranks() -> int:
    return _environment_number(("OMPI_COMM_WORLD_SIZE", "PMI_SIZE"), 1)


def _environment_number(names: Sequence[str], otherwise: int) -> int:
    return next((int(os.environ[name]) for name in names if os.environ.get(name, "").isdecimal()), otherwise)
