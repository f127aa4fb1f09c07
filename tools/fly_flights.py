"""Flies the example flights in JSBSim and writes them to examples/flights/ as CSV.

    python -m tools.fly_flights [--out examples/flights] [--only loop]

JSBSim (PyPI package jsbsim, in the `dev` extra) ships the aircraft. The pilot below only moves stick, rudder and
throttle; what the attitude does is the aircraft's answer. Every flight starts from JSBSim's own trim in level flight.
The same versions of JSBSim and this file write the same bytes each time.
"""

import argparse
import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import jsbsim
import numpy as np

from fullpose._typing import Array
from fullpose.attitude import quaternion_from_dcm
from tools.autopilot import STEP_HZ, Gains, Manoeuvre, Pilot, levelled

RATE_HZ = 200  # the rows written
REPOSITORY = Path(__file__).parents[1]
DEMO = "loop_and_roll"  # the flight that `fullpose demo` flies; the package carries a copy
DIGITS = 12  # of a quaternion's component; the angles get the same resolution


@dataclass(frozen=True)
class Flight:
    """One flight: aircraft, where it starts, and the manoeuvre."""

    name: str
    aircraft: str
    altitude_ft: float
    speed_kt: float
    heading_deg: float
    gains: Gains
    columns: str  # "quaternion" or "euler"
    manoeuvre: Callable[["Pilot"], Manoeuvre]


def loop(pilot: Pilot) -> Manoeuvre:
    """Level; full power; a loop of about 7 g at the bottom and 4 g over the top; level again."""
    level = pilot.now.body_from_ned.copy()
    yield from pilot.hold(level, 2.0)
    pilot.throttle(1.0)
    yield from pilot.pull(math.radians(20.0), math.tau, math.radians(14.0))
    yield from pilot.hold(level, 4.0)


def loop_and_roll(pilot: Pilot) -> Manoeuvre:
    """A loop, then nose up 12 deg and one turn to the left at 45 deg/s, then level.

    Flown east: the nose goes by both directions in which a three-axis table is singular, up and along the outer axis
    of a horizontal one.
    """
    level = pilot.now.body_from_ned.copy()
    yield from pilot.hold(level, 2.0)
    pilot.throttle(1.0)
    yield from pilot.pull(math.radians(20.0), math.tau, math.radians(14.0))
    raised = levelled(level, math.radians(12.0))
    yield from pilot.hold(raised, 3.0)
    yield from pilot.roll(math.radians(-45.0), math.tau, raised[0])
    yield from pilot.hold(levelled(pilot.now.body_from_ned, math.radians(5.0)), 4.0)


def slow_roll(pilot: Pilot) -> Manoeuvre:
    """Nose up 12 deg, one turn to the left at 45 deg/s, then level."""
    level = pilot.now.body_from_ned.copy()
    yield from pilot.hold(level, 2.0)
    pilot.throttle(1.0)
    raised = levelled(level, math.radians(12.0))
    yield from pilot.hold(raised, 3.0)
    yield from pilot.roll(math.radians(-45.0), math.tau, raised[0])
    yield from pilot.hold(levelled(pilot.now.body_from_ned, math.radians(5.0)), 4.0)


def split_s(pilot: Pilot) -> Manoeuvre:
    """Half roll to inverted, throttle back, half a loop downward, out level on the opposite heading."""
    level = pilot.now.body_from_ned.copy()
    yield from pilot.hold(level, 2.0)
    yield from pilot.roll(math.radians(60.0), math.pi, level[0], ease=1.2)
    pilot.throttle(0.6)
    yield from pilot.pull(math.radians(12.0), math.pi, math.radians(15.0))
    pilot.throttle(0.8)
    yield from pilot.hold(levelled(pilot.now.body_from_ned, math.radians(3.0)), 4.0)


FLIGHTS = {
    flight.name: flight
    for flight in (
        Flight("loop", "A4", 8_000, 420, 40.0, Gains(0.5, 0.5, 0.8, 2.5, 0.5, 1.0), "quaternion", loop),
        Flight(DEMO, "A4", 8_000, 420, 90.0, Gains(0.5, 0.5, 0.8, 2.5, 0.5, 1.0), "quaternion", loop_and_roll),
        Flight("slow_roll", "t6texan2", 10_000, 180, 350.0, Gains(0.5, 0.8, 0.8, 2.5, 1.2, 1.0), "euler", slow_roll),
        Flight("split_s", "T38", 18_000, 280, 120.0, Gains(0.5, 0.5, 0.8, 2.5, 0.5, 1.0), "quaternion", split_s),
    )
}


def fly(flight: Flight, seconds: float = math.inf) -> tuple[Array, Array]:
    """Fly it, for `seconds` at most: time (n,) [s] from zero, and body-from-NED attitudes (n, 3, 3), `RATE_HZ`."""
    os.environ.setdefault("JSBSIM_DEBUG", "0")  # read by the constructor, which would print a banner
    aircraft = jsbsim.FGFDMExec(None)
    if not aircraft.load_model(flight.aircraft):
        raise SystemExit(f"JSBSim has no aircraft {flight.aircraft!r}")
    aircraft.set_dt(1.0 / STEP_HZ)
    for name, value in (
        ("ic/h-sl-ft", flight.altitude_ft),
        ("ic/vc-kts", flight.speed_kt),
        ("ic/psi-true-deg", flight.heading_deg),
        ("ic/gamma-deg", 0.0),
        ("simulation/randomseed", 1.0),
    ):
        aircraft[name] = value
    aircraft.run_ic()
    aircraft["propulsion/set-running"] = -1  # all engines
    aircraft["simulation/do_simple_trim"] = 0  # longitudinal; raises where it fails
    # Light turbulence (MIL-F-8785C), or the wings would stay level to the last digit, as they never do.
    aircraft["atmosphere/turb-type"] = 3
    aircraft["atmosphere/turbulence/milspec/windspeed_at_20ft_AGL-fps"] = 25.0
    aircraft["atmosphere/turbulence/milspec/severity"] = 3

    pilot = Pilot(aircraft, flight.gains, flight.speed_kt)
    attitudes = [pilot.now.body_from_ned.copy()]
    every = STEP_HZ // RATE_HZ
    for steps, wanted in enumerate(flight.manoeuvre(pilot), start=1):
        pilot.step(wanted)
        if steps % every == 0:
            attitudes.append(pilot.now.body_from_ned.copy())
        if len(attitudes) > 60 * RATE_HZ:
            raise SystemExit(f"{flight.name}: not flown after 60 s")
        if steps / STEP_HZ >= seconds:
            break
    return np.arange(len(attitudes)) / RATE_HZ, np.stack(attitudes)


def table(flight: Flight, time: Array, attitude: Array) -> str:
    """The CSV text: `time_s` and the flight's columns, north-east-down."""
    if flight.columns == "euler":
        C = attitude
        columns = np.degrees(
            np.stack(
                [
                    np.mod(np.arctan2(C[:, 0, 1], C[:, 0, 0]), math.tau),
                    np.arctan2(-C[:, 0, 2], np.hypot(C[:, 0, 0], C[:, 0, 1])),
                    np.arctan2(C[:, 1, 2], C[:, 2, 2]),
                ],
                axis=-1,
            )
        )
        header, digits = "time_s,heading_deg,pitch_deg,bank_deg", DIGITS - 2
    else:
        columns = quaternion_from_dcm(attitude)
        # One of q and -q, without a jump.
        flips = np.cumsum(np.einsum("ni,ni->n", columns[1:], columns[:-1]) < 0.0) % 2
        columns[1:][flips == 1] *= -1.0
        header, digits = "time_s,qw,qx,qy,qz", DIGITS
    columns = np.round(columns, digits) + 0.0  # no negative zero
    rows = [f"{t:.3f}," + ",".join(f"{v:.{digits}f}" for v in row) for t, row in zip(time, columns, strict=True)]
    return "\n".join([header, *rows]) + "\n"


def main() -> None:
    """Fly and write; one line a flight."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=REPOSITORY / "examples" / "flights")
    parser.add_argument("--only", choices=sorted(FLIGHTS))
    arguments = parser.parse_args()
    for flight in FLIGHTS.values():
        if arguments.only in (None, flight.name):
            time, attitude = fly(flight)
            text = table(flight, time, attitude)
            arguments.out.mkdir(parents=True, exist_ok=True)
            path = arguments.out / f"{flight.name}.csv"
            path.write_text(text)
            print(f"{path}: {time[-1]:.2f} s, {len(time)} samples, {flight.aircraft}")
            if flight.name == DEMO and arguments.out == REPOSITORY / "examples" / "flights":
                (REPOSITORY / "server" / "fullpose_server" / "demo_flights" / f"{DEMO}.csv").write_text(text)


if __name__ == "__main__":
    main()
