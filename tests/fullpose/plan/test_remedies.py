"""Remedies: each is a plan that flies, and a little less of it does not."""

import numpy as np
import pytest

from fullpose.attitude import dcm_from_euler
from fullpose.errors import CancelledError, InputError, OutOfTimeError
from fullpose.plan import plan
from fullpose.plan.impossible import beyond_all_frames
from fullpose.plan.remedies import offset, raised, relax, slow_down, tolerance, turned
from fullpose.plan.remedy import NOTHING, Trials
from fullpose.rig import FrameLimits, Geometry, Rig, builtin_rigs
from fullpose.verify import payload_attitudes, verify
from fullpose.vocabulary import RemedyKind

DEG = np.pi / 180.0


def base_alone(rate: float, span: float = np.inf) -> Rig:
    """A rig whose base alone turns, at `rate` [rad/s] at most."""
    still = FrameLimits(-1e-6, 1e-6)
    return Rig("base", Geometry.VERTICAL_4, (FrameLimits(-span, span, rate), still, still, still))


TIME = np.arange(0.0, 3.0, 0.02)
YAW = dcm_from_euler(40 * DEG * np.sin(TIME), 0.0, 0.0)  # 40 deg/s at most


def flies(remedy):
    found = verify(remedy.time, remedy.plan.solution.angles, remedy.rig, remedy.attitude)
    return remedy.plan.verdict.feasible and found.violations == () and found.max_error < 1e-12


def test_slow_down_is_the_ratio_of_the_rates():
    remedy = slow_down(TIME, YAW, base_alone(25 * DEG))
    assert flies(remedy)
    assert remedy.value == pytest.approx(40 / 25, rel=0.02)
    assert np.allclose(np.diff(remedy.time), 0.02)  # at the flight's own sample rate
    assert remedy.time[-1] == pytest.approx(remedy.value * TIME[-1], abs=0.02)


def test_slow_down_leaves_a_flight_that_fits():
    remedy = slow_down(TIME, YAW, base_alone(50 * DEG))
    assert remedy.value == 1.0
    assert flies(remedy)


def test_a_flight_that_fits_but_cannot_brake_after_its_end_is_slowed_until_it_can():
    # 2 deg before its stop the base goes at 40 deg/s, and 4 deg are needed to brake.
    yaw = dcm_from_euler((58 * DEG - 40 * DEG * (TIME[-1] - TIME)), 0.0, 0.0)
    still = FrameLimits(-1e-6, 1e-6)
    base = FrameLimits(-80 * DEG, 60 * DEG, 100 * DEG, 200 * DEG)
    rig = Rig("base", Geometry.VERTICAL_4, (base, still, still, still))
    as_it_is = plan(TIME, yaw, rig)
    assert as_it_is.verdict.feasible
    assert "base frame's position" in as_it_is.lead_refusal
    assert not as_it_is.ready
    remedy = slow_down(TIME, yaw, rig)
    assert flies(remedy)
    assert remedy.plan.ready
    assert 1.4 < remedy.value < 2.0  # v^2 / 2a = 2 deg at 1.41 times the time, and a smooth lead takes a little more
    assert remedy.plan.lead_out[-1, 0] <= 60 * DEG


def test_slow_down_says_where_no_factor_does():
    remedy = slow_down(TIME, YAW, base_alone(50 * DEG, 30 * DEG), largest=2.0)
    assert remedy.value == 2.0
    assert not remedy.plan.verdict.feasible


def test_relax_finds_every_single_limit_that_does():
    remedies = relax(TIME, YAW, base_alone(25 * DEG))
    # The middle frame could take the yaw too, were it let: both are found, and nothing else.
    assert sorted(remedy.what for remedy in remedies) == ["base rate", "middle position"]
    assert all(flies(remedy) for remedy in remedies)
    raise_of_rate = next(remedy for remedy in remedies if remedy.what == "base rate")
    assert raise_of_rate.value == pytest.approx(40 * DEG, rel=0.025)


def test_relax_finds_the_range():
    remedies = relax(TIME, YAW, base_alone(50 * DEG, 30 * DEG), frame="base")
    assert [remedy.what for remedy in remedies] == ["base position"]
    assert flies(remedies[0])
    assert 40 * DEG <= remedies[0].value < 42.5 * DEG


def test_relax_leaves_a_flight_that_fits():
    rig = base_alone(50 * DEG)
    (remedy,) = relax(TIME, YAW, rig)
    assert (remedy.what, remedy.value) == (NOTHING, 0.0)
    assert remedy.rig is rig
    assert flies(remedy)


def test_relax_is_empty_where_no_single_limit_is_enough():
    assert relax(TIME, YAW, base_alone(25 * DEG), limit="acceleration") == []


def test_heading_offset_brings_the_flight_into_the_range():
    C = dcm_from_euler(100 * DEG + 40 * DEG * np.sin(TIME), 0.0, 0.0)
    rig = base_alone(400 * DEG, 60 * DEG)
    assert not plan(TIME, C, rig).verdict.feasible
    remedy = offset(TIME, C, rig, RemedyKind.HEADING_OFFSET)
    assert flies(remedy)
    # Yaw 100..140 deg lies best in the middle of +-60.
    assert remedy.value == pytest.approx(-120 * DEG, abs=10 * DEG)
    assert np.allclose(remedy.attitude, dcm_from_euler(100 * DEG + remedy.value + 40 * DEG * np.sin(TIME), 0.0, 0.0))


def test_mounting_offset_turns_the_payload():
    # Roll about 90 deg, and no frame but the inner one can roll.
    still = FrameLimits(-5 * DEG, 5 * DEG)
    rig = Rig("roll", Geometry.VERTICAL_4, (still, still, still, FrameLimits(-60 * DEG, 60 * DEG)))
    C = dcm_from_euler(0.0, 0.0, 90 * DEG + 20 * DEG * np.sin(TIME))
    remedy = offset(TIME, C, rig, RemedyKind.MOUNTING_OFFSET, step=45 * DEG)
    assert flies(remedy)
    assert remedy.what == "roll"
    assert remedy.value == pytest.approx(-90 * DEG, abs=23 * DEG)


def test_turned_is_what_it_says():
    C = dcm_from_euler(0.3, 0.2, 0.1)
    assert np.allclose(turned(C, RemedyKind.HEADING_OFFSET, "yaw", 0.4), dcm_from_euler(0.7, 0.2, 0.1))
    assert np.allclose(turned(C, RemedyKind.MOUNTING_OFFSET, "roll", 0.4), dcm_from_euler(0.3, 0.2, 0.5))


def test_raised_changes_one_limit_of_one_frame():
    rig = builtin_rigs()["vertical-limited"]
    for frame, kind in ((1, 1), (2, 2), (3, 0)):
        wider = raised(rig, frame, kind, 0.5, 4.0)
        differing = [k for k in range(4) if wider.frames[k] != rig.frames[k]]
        assert differing == [frame]
    assert raised(rig, 1, 1, 1.0, 4.0).max_rate[1] == pytest.approx(4.0 * rig.max_rate[1])


def test_progress_counts_to_the_end_and_cancels():
    told = []
    relax(TIME, YAW, base_alone(25 * DEG), progress=lambda done, total: told.append((done, total)))
    assert [done for done, _ in told] == sorted(done for done, _ in told)

    def stop(done, total):
        if done > 2:
            raise CancelledError("enough")

    with pytest.raises(CancelledError):
        slow_down(TIME, YAW, base_alone(5 * DEG), progress=stop)


def test_names_that_are_none():
    with pytest.raises(InputError, match="kind"):
        offset(TIME, YAW, base_alone(1.0), "sideways")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="frame"):
        relax(TIME, YAW, base_alone(1.0), frame="third")
    with pytest.raises(InputError, match="limit"):
        relax(TIME, YAW, base_alone(1.0), limit="snap")
    with pytest.raises(InputError, match="outer, middle, inner, the frames of vertical-3"):
        relax(TIME, YAW, builtin_rigs()["vertical-3"], frame="base")


def test_the_least_tolerance_is_a_remedy_and_says_what_it_costs():
    """20 deg in half a second with half the rate: the ramp through the middle of the step misses it by 5 deg."""
    yaw = 20 * DEG * np.clip(TIME - 1.25, 0.0, 0.5) / 0.5
    remedy = tolerance(TIME, dcm_from_euler(yaw, 0.0, 0.0), base_alone(20 * DEG))
    assert remedy.plan.ready
    assert remedy.value == pytest.approx(5 * DEG, rel=0.1)
    off = np.abs(remedy.plan.solution.angles[:, 0] - yaw)  # the base alone turns: the attitude error is its own
    assert remedy.deviation == pytest.approx(off, abs=1e-4)
    assert remedy.deviation.max() <= remedy.value
    assert verify(remedy.time, remedy.plan.solution.angles, remedy.rig).violations == ()


def test_a_search_for_an_exact_path_that_takes_too_long_is_given_up_for_the_tolerance():
    """And nobody gives up the plan that is returned, whose progress is told all the same."""
    told = []
    yaw = 20 * DEG * np.clip(TIME - 1.25, 0.0, 0.5) / 0.5
    remedy = tolerance(TIME, dcm_from_euler(yaw, 0.0, 0.0), base_alone(20 * DEG), progress=never_long_but_last(told))
    assert remedy.given_up == 1
    assert remedy.plan.ready
    assert remedy.value == pytest.approx(5 * DEG, rel=0.1)
    assert {total for _, total in told} == {2}
    assert max(done for done, _ in told) == 2


def never_long_but_last(told):
    """Progress that gives up whatever is not the end."""

    def progress(done, total):
        told.append((done, total))
        if done < total:
            raise OutOfTimeError("too long")

    return progress


def test_a_flight_that_fits_needs_no_tolerance():
    remedy = tolerance(TIME, YAW, base_alone(50 * DEG))
    assert (remedy.what, remedy.value) == (NOTHING, 0.0)
    assert flies(remedy)


def test_of_a_recorded_flight_the_noise_is_what_the_tolerance_takes():
    random, sigma = np.random.default_rng(0), 0.01 * DEG
    t = np.arange(0.0, 3.0, 0.002)
    yaw, noise = 40 * DEG * np.sin(t), sigma * random.normal(size=len(t))
    rig = builtin_rigs()["vertical-limited"]
    remedy = tolerance(t, dcm_from_euler(yaw + noise, 0.0, 0.0), rig)
    assert remedy.plan.ready
    assert 2.0 * sigma < remedy.value < 8.0 * sigma
    assert remedy.deviation.max() <= remedy.value


def test_a_slower_flight_that_fails_again_is_told(monkeypatch):
    """Fits from 1.6 times on, but not beyond 2.7: what halving assumes not to be."""
    honest = Trials.fits

    def fits(self, time, attitude, rig):
        return honest(self, time, attitude, rig) and time[-1] < 2.7 * TIME[-1]

    monkeypatch.setattr(Trials, "fits", fits)
    remedy = slow_down(TIME, YAW, base_alone(25 * DEG))
    assert flies(remedy)
    assert remedy.value == pytest.approx(1.6, rel=0.02)
    assert remedy.fails_again == pytest.approx(1.8 * remedy.value)


def test_a_trial_that_is_given_up_counts_as_failed_and_the_search_goes_on():
    def slow_first(done, total):
        assert total >= done
        if done == 1:
            raise OutOfTimeError("too long")

    remedy = slow_down(TIME, YAW, base_alone(50 * DEG), progress=slow_first)
    assert flies(remedy)
    assert remedy.given_up == 1
    assert 1.0 < remedy.value <= 1.0 + 2 * 0.01  # the flight as it is fits, but that trial was given up
    told = []
    slow_down(TIME, YAW, base_alone(25 * DEG), progress=lambda done, total: told.append((done, total)))
    assert max(done for done, _ in told) <= told[0][1]


@pytest.mark.parametrize("name", ["vertical-limited", "horizontal-4", "vertical-3"])
@pytest.mark.parametrize("seed", range(4))
def test_no_motion_of_the_frames_inside_their_limits_is_beyond_all_of_them(name, seed):
    """Frames that swing at their limits: the body stays below the bound, with noise on it it does not."""
    rig = builtin_rigs()[name]
    random = np.random.default_rng(seed)
    t = np.arange(0.0, 1.0, 0.001)
    frames = list(rig.geometry.frames)
    rate, w = rig.max_rate[frames], rig.max_acceleration[frames] / rig.max_rate[frames]
    x = np.zeros((len(t), 4))  # a sine of rate v and acceleration a has w = a / v
    x[:, frames] = rate / w * np.sin(w * t[:, None] + random.uniform(0.0, 6.0, len(frames)))
    assert beyond_all_frames(t, payload_attitudes(rig, x), rig) is None
    noise = 0.05 * DEG * random.normal(size=x.shape) * (rig.axes >= 0)
    found = beyond_all_frames(t, payload_attitudes(rig, x + noise), rig)
    assert found is not None
    assert found.needed > found.most
