"""The command ``dustdetach``: a thin layer over the library.

Exit status: 0 done; 1 something is missing or some cases failed; 2 bad input, one line on standard error, nothing
written; 130 interrupted.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from io import TextIOWrapper
from pathlib import Path
from typing import NoReturn, TypeAlias

from .about import option
from .cases import NAMED, json_schema, named_or_file, with_methods
from .completion import SHELLS, completion
from .errors import DustError, InvalidInput, one_line, shown
from .files import writable_file
from .impact import Impact
from .materials import PROPERTIES, find_material, materials, use_materials
from .parameters import ABOUT, DISTRIBUTIONS, METHODS, PARAMETER_TYPES, PARAMETERS, Parameters
from .result import Result, described_materials
from .version import __version__

_Commands: TypeAlias = "argparse._SubParsersAction[_Parser]"
#: parameters of a texture
_TEXTURE = ("coverage", "bare", "grain_diameter", "carrier_diameter", "spread", "seed")
#: parameters of measured impacts that a fit can be told; those that are left out make no difference to it
_FIT = tuple(
    name
    for name in PARAMETERS
    if name not in ("method", "seed", "coverage", "wall_hamaker", "grain_hamaker", "tangential")
)
#: these two and the grains' diameter make --distribution
_DISTRIBUTION = ("distribution", "distribution_spread")


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
    _add_parameters(impact, PARAMETERS)
    impact.add_argument("--json", action="store_true", help="print one JSON object")
    impact.add_argument(
        "--picture", type=Path, metavar="PNG", help="draw the carrier after the impact; four moments of a resolved one"
    )

    sweep = _command(commands, "sweep", "many impacts into a folder; picks up where it stopped", _sweep)
    sweep.add_argument("cases", metavar="|".join(NAMED) + "|FILE.toml", help="a figure of the paper, or a TOML file")
    sweep.add_argument("--method", help=", ".join(METHODS) + f", both (as the cases say, else {Parameters.method})")
    _add_materials(sweep)
    sweep.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder of the results")
    sweep.add_argument("--jobs", type=int, default=1, metavar="N", help="processes (1)")
    sweep.add_argument("--parquet", action="store_true", help="write results.parquet beside results.csv, with units")
    sweep.add_argument("--executor", default="local", help="local, or mpi under mpirun (local)")

    plot = _command(commands, "plot", "figures of a sweep as PNG and SVG", _plot)
    plot.add_argument("folder", type=Path, metavar="DIR", help="folder of a sweep")
    for role, what in (("x", "along the axis"), ("color", "told by colour"), ("panel", "with a panel for each value")):
        plot.add_argument(f"--{role}", metavar="P", help=f"the parameter {what}, in place of the figures by speed")
    plot.add_argument("--y", metavar="COLUMN", help="the column drawn by --x (dispersion_ratio)")
    plot.add_argument("--map", metavar="X,Y", help="a map of the dispersion ratio over two parameters")

    fit = _command(commands, "fit", "material parameters from measured dispersion ratios, with intervals", _fit)
    fit.add_argument(
        "data", type=Path, metavar="DATA.csv", help="columns named as in results.csv; uncertainty, if known"
    )
    fit.add_argument(
        "--free",
        default="z0,spread",
        metavar="NAMES",
        help="what is fitted: z0, surface_energy or hamaker, spread, friction (z0,spread)",
    )
    fit.add_argument("--json", action="store_true", help="print one JSON object: for each parameter value, low, high")
    fit.add_argument(
        "--picture", type=Path, metavar="PNG", help="draw data and fit (DATA.fit.png; with --json only if given)"
    )
    _add_parameters(fit, _FIT, required=())

    sensitivity = _command(commands, "sensitivity", "which uncertain input matters: Sobol indices", _sensitivity)
    sensitivity.add_argument("cases", metavar="FILE.toml", help="one value, or a distribution, for each parameter")
    _add_materials(sensitivity)
    sensitivity.add_argument("--json", action="store_true", help="print one JSON object")

    texture = commands.add_parser("texture", help="make, check or draw a texture", description="Textures of grains.")
    textures = texture.add_subparsers(required=True, metavar="COMMAND")
    make = _command(textures, "make", "place grains on a carrier and write them to a file", _texture_make)
    _add_parameters(make, (*_TEXTURE, *_DISTRIBUTION))
    make.add_argument("--out", type=Path, required=True, metavar="FILE", help="texture file")
    make.add_argument("--picture", type=Path, metavar="PNG", help="draw it, too")
    check = _command(textures, "check", "check a texture file", _texture_check)
    check.add_argument("file", type=Path, metavar="FILE", help="texture file")
    draw = _command(textures, "draw", "draw a carrier with its grains", _texture_draw)
    draw.add_argument("file", type=Path, metavar="FILE", help="texture file")
    draw.add_argument("--out", type=Path, required=True, metavar="PNG", help="picture")

    shown_materials = _command(
        commands, "materials", "the materials that have a name, and where their numbers are from", _materials
    )
    shown_materials.add_argument("names", nargs="*", metavar="NAME", help="these alone")
    _add_materials(shown_materials)
    shown_materials.add_argument("--json", action="store_true", help="print one JSON object")

    complete = _command(commands, "completion", "a script that completes commands and options in a shell", _completion)
    complete.add_argument("shell", metavar="|".join(SHELLS))

    _command(commands, "schema", "JSON Schema of a sweep's TOML file, for editors", _schema)

    _command(commands, "doctor", "what is installed, and what is wrong with it", _doctor)
    report = _command(
        commands, "report", "one HTML file of a sweep, to mail: figures, table, a carrier that turns", _report
    )
    report.add_argument("folder", type=Path, metavar="DIR", help="folder of a sweep")
    report.add_argument("--out", type=Path, metavar="FILE", help="the file (report.html in the folder)")
    return parser


def _command(commands: _Commands, name: str, text: str, run: Callable[[argparse.Namespace, bool], int]) -> _Parser:
    parser = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".", allow_abbrev=False)
    parser.set_defaults(run=run, program=parser.prog)
    return parser


def _add_parameters(
    parser: argparse.ArgumentParser, names: Sequence[str], required: Sequence[str] = ("speed",)
) -> None:
    """The options of parameters, and those that stand for several of them."""
    for name in names:
        if name == "distribution":
            parser.add_argument(
                "--distribution",
                nargs=3,
                default=argparse.SUPPRESS,
                metavar=("KIND", "X50", "SPREAD"),
                help="of sizes by volume: lognormal, median (m) and geometric standard deviation, or rrsb, median and "
                "exponent; in place of --grain-diameter",
            )
        elif name != "distribution_spread":
            _add_parameter(parser, name, required=name in required)
    _add_materials(parser)


def _add_parameter(parser: argparse.ArgumentParser, name: str, *, required: bool) -> None:
    about, default = ABOUT[name], getattr(Parameters, name, None)
    unit = f", {about.unit}" if about.unit else ""
    if about.follows:
        unit += f" ({about.follows})"
    elif PARAMETER_TYPES[name] == "bool":
        unit += f" ({option(name)})"
    elif default is not None:
        unit += f" ({default:g})" if isinstance(default, float) else f" ({default})"
    words = (about.help + unit).replace("%", "%%")
    if PARAMETER_TYPES[name] == "bool":
        parser.add_argument(option(name), action=argparse.BooleanOptionalAction, default=argparse.SUPPRESS, help=words)
        return
    kind = {"float": float, "int": int, "str": str}[PARAMETER_TYPES[name]]
    parser.add_argument(
        option(name),
        type=kind,
        required=required,
        default=argparse.SUPPRESS,
        metavar="WORD" if kind is str else "N" if kind is int else "X",
        help=words,
    )


def _add_materials(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--materials", type=Path, metavar="FILE", help="TOML file of materials of your own")


def _given(options: argparse.Namespace, names: Sequence[str]) -> dict[str, object]:
    """The parameters that options give; --distribution gives three."""
    if options.materials is not None:
        use_materials(options.materials)
    values = {name: getattr(options, name) for name in names if hasattr(options, name)}
    if "distribution" in values:
        if "grain_diameter" in values:
            raise InvalidInput("--grain-diameter: the median of --distribution takes its place; allowed: one of both")
        kind, *numbers = values["distribution"]
        if kind not in DISTRIBUTIONS[1:]:
            allowed = ", ".join(DISTRIBUTIONS[1:])
            raise InvalidInput(f"--distribution: unknown choice {shown(kind)}; allowed: {allowed}")
        try:
            median, spread = map(float, numbers)
        except ValueError:
            raise InvalidInput(f"--distribution: {' '.join(numbers)}: not two numbers") from None
        for name, value in (("median diameter", median), ("spread", spread)):
            if not value > 0 or math.isinf(value):
                raise InvalidInput(f"--distribution: {name} {value:g} is out of range; allowed: above 0")
        values |= {"distribution": kind, "grain_diameter": median, "distribution_spread": spread}
    return values


def _impact(options: argparse.Namespace, _: bool) -> int:
    impact = Impact.from_mapping(_given(options, PARAMETERS))
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
        knocked = f"   knocked off {result.knocked:.4f}" if result.meet else ""
        modes = [f"  by lift-off      normal {result.normal:.4f}   tangential {result.tangential_mode:.4f}{knocked}"]
    return "\n".join(
        [
            f"impact at {result.speed:g} m/s, {result.angle:g} degrees, restitution {result.restitution:g}, "
            f"{result.grains} grains",
            *described_materials(result),
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

    if options.materials is not None:
        use_materials(options.materials)
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
    if speaks and options.parquet:
        from .result import read_csv
        from .tables import PARQUET, write_parquet

        print(write_parquet(options.out / PARQUET, read_csv(options.out / "results.csv")))
    return 0


def _progress() -> Callable[[int, int, float], None]:
    """Cases done, pace and time left, off a terminal at the start and at each tenth of the way."""
    line = _StatusLine()

    def tell(done: int, total: int, left: float) -> None:
        pace = f"{(total - done) / left:.3g} a second, " if left else ""
        # marks from 1: the start is one
        mark = 1 + 10 * done // max(total, 1)
        line.tell(f"{done}/{total} cases, {pace}{left:.0f} s left", mark, "\n" if done == total else "")

    return tell


def _plot(options: argparse.Namespace, _: bool) -> int:
    roles = {
        role: value.replace("-", "_")
        for role in ("x", "color", "panel", "y")
        if (value := getattr(options, role)) is not None
    }
    if options.map is not None:
        from .plots import plot_map

        if set(roles) - {"panel"}:
            raise InvalidInput("--map: has both axes; allowed: with --panel alone")
        axes = [name.strip().replace("-", "_") for name in options.map.split(",")]
        if len(axes) != 2:
            raise InvalidInput(f"--map: {options.map}; allowed: two parameters with a comma between them")
        paths = plot_map(options.folder, *axes, **roles)
    elif roles:
        from .plots import plot_by

        paths = plot_by(options.folder, **roles)
    else:
        from .figures import plot

        paths = plot(options.folder)
    for path in paths:
        print(path)
    return 0


def _texture_make(options: argparse.Namespace, _: bool) -> int:
    from .texture import make_texture, read_texture

    # the speed of the impact does not matter to its texture
    impact = Impact.from_mapping({"speed": 1.0, **_given(options, (*_TEXTURE, "distribution"))})
    out = writable_file(options.out, "--out")
    picture = _png(options.picture, "--picture") if options.picture else None
    make_texture(impact, out)
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


def _fit(options: argparse.Namespace, _: bool) -> int:
    from .fitting import fit, read_data

    free = tuple(name.strip().replace("-", "_") for name in options.free.split(",") if name.strip())
    picture = options.picture
    if picture is None and not options.json:
        picture = options.data.with_suffix(".fit.png")
    if picture is not None:
        picture = _png(picture, "--picture")
    found = fit(read_data(options.data, free, _given(options, _FIT)), free)
    if picture is not None:
        from .fit_figure import draw_fit

        draw_fit(found, picture)
    if options.json:
        print(json.dumps(found.to_mapping()))
        return 0
    for name, estimate in found.estimates.items():
        about = ABOUT[name]
        unit = f" {about.unit}" if about.unit else ""
        print(
            f"{name:15} {estimate.value:.4g}{unit}  ({estimate.low:.4g} to {estimate.high:.4g}, 95 % for all at once)"
        )
    for name in found.untold:
        print(f"{name:15} not told by the data")
    print("\n".join([*found.words, *described_materials(found.data.impacts[0])[:3], str(picture)]))
    return 0


def _sensitivity(options: argparse.Namespace, _: bool) -> int:
    from .sensitivity import sensitivity

    if options.materials is not None:
        use_materials(options.materials)
    line, began = _StatusLine(), time.monotonic()

    def watch(done: int, total: int) -> None:
        left = (time.monotonic() - began) / done * (total - done)
        line.tell(f"{done}/{total} impacts, {left:.0f} s left", 10 * done // total, "\n" if done == total else "")

    found = sensitivity(options.cases, watch)
    if options.json:
        print(json.dumps(vars(found)))
        return 0
    print(f"dispersion ratio   {found.mean:.4f} +- {found.deviation:.4f} ({found.impacts} impacts)")
    for name in sorted(found.first, key=lambda name: -found.total[name]):
        print(f"{name:18} first order {found.first[name]:5.2f}   total {found.total[name]:5.2f}")
    return 0


def _materials(options: argparse.Namespace, _: bool) -> int:
    if options.materials is not None:
        use_materials(options.materials)
    chosen = [find_material(name, "materials") for name in options.names] or materials()
    if options.json:
        listed = {
            each.name: {
                "also": list(each.also),
                **{
                    key: {"value": getattr(each, key), "unit": about.unit, "source": each.sources.get(key, "")}
                    for key, about in PROPERTIES.items()
                },
            }
            for each in chosen
        }
        print(json.dumps(listed, indent=1, ensure_ascii=False))
        return 0
    for each in chosen:
        print(each.name + (f" ({', '.join(each.also)})" if each.also else ""))
        for key, about in PROPERTIES.items():
            value = getattr(each, key)
            if value is not None:
                print(f"  {key:8} {f'{value:g} {about.unit}'.strip():14} {each.sources[key]}")
    return 0


def _completion(options: argparse.Namespace, _: bool) -> int:
    if options.shell not in SHELLS:
        raise InvalidInput(f"{shown(options.shell)}: unknown shell; allowed: {', '.join(SHELLS)}")
    print(completion(_parser(), options.shell), end="")
    return 0


def _schema(_: argparse.Namespace, __: bool) -> int:
    print(json.dumps(json_schema(), indent=1))
    return 0


def _doctor(_: argparse.Namespace, __: bool) -> int:
    from .doctor import examine

    findings = examine()
    for finding in findings:
        print(f"{'  ok ' if finding.ok else 'WRONG'}  {finding.what}: {finding.found}")
    return 0 if all(finding.ok for finding in findings) else 1


def _report(options: argparse.Namespace, _: bool) -> int:
    from .report import write_report

    out = options.out if options.out is None else writable_file(options.out, "--out")
    print(write_report(options.folder, out))
    return 0


def _rank() -> int:
    return _environment_number(("OMPI_COMM_WORLD_RANK", "PMI_RANK"), 0)


def _ranks() -> int:
    return _environment_number(("OMPI_COMM_WORLD_SIZE", "PMI_SIZE"), 1)


def _environment_number(names: Sequence[str], otherwise: int) -> int:
    return next((int(os.environ[name]) for name in names if os.environ.get(name, "").isdecimal()), otherwise)
