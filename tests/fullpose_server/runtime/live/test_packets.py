"""The datagrams of a live source: every kind, and what is none."""

import math

import numpy as np
import pytest

from fullpose.attitude import dcm_from_quaternion, euler_from_ned, quaternion_from_euler, quaternion_from_ned
from fullpose_server.runtime.live.packets import (
    SAMPLE_SIZE,
    Kind,
    LiveReply,
    LiveStatus,
    decode_reply,
    decode_sample,
    encode_reply,
    encode_sample,
)

NAN = math.nan


def test_every_kind_is_the_attitude_that_the_solver_reads() -> None:
    euler = (40.0, -25.0, 130.0)
    radians = np.radians(euler)
    ours = quaternion_from_euler(*radians)[0]
    ned = quaternion_from_euler(*euler_from_ned(*radians))[0]
    for kind, numbers, expected in (
        (Kind.EULER, euler, ours),
        (Kind.EULER_NED, euler, ned),
        (Kind.QUATERNION, tuple(ours), ours),
        (Kind.QUATERNION_NED, tuple(ours), quaternion_from_ned(ours[None])[0]),
    ):
        sample = decode_sample(encode_sample(kind, 3, 1.5, numbers, ()))
        assert sample is not None
        assert (sample.sequence, sample.time_s, sample.rate) == (3, 1.5, None)
        np.testing.assert_allclose(
            dcm_from_quaternion(np.array(sample.quaternion)), dcm_from_quaternion(expected), atol=1e-15
        )


def test_ned_body_rates_change_axes_with_the_attitude() -> None:
    sample = decode_sample(encode_sample(Kind.EULER_NED, 0, 0.0, (0.0, 0.0, 0.0), (10.0, 20.0, 30.0)))
    assert sample is not None
    # Forward-right-down p, q, r are ours about x, z and -y.
    np.testing.assert_allclose(np.degrees(sample.rate), [10.0, -30.0, 20.0])  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"FPA1",
        b"\0" * SAMPLE_SIZE,
        encode_sample(Kind.QUATERNION, 0, 0.0, (NAN, 0.0, 0.0, 0.0), ()),
        encode_sample(Kind.QUATERNION, 0, 0.0, (1.0, 0.0, 0.0, NAN), ()),
        encode_sample(Kind.QUATERNION, 0, NAN, (1.0, 0.0, 0.0, 0.0), ()),
        encode_sample(Kind.QUATERNION, 0, 0.0, (0.0, 0.0, 0.0, 0.0), ()),
        encode_sample(Kind.EULER, 0, 0.0, (1.0, math.inf, 0.0), ()),
        encode_sample(9, 0, 0.0, (1.0, 0.0, 0.0, 0.0), ()),  # type: ignore[arg-type]
    ],
)
def test_what_is_no_sample_is_not_believed(data: bytes) -> None:
    assert decode_sample(data) is None


def test_replies_come_back_as_they_went() -> None:
    reply = LiveReply(int(LiveStatus.FOLLOWED), 5, 2.5, (1.0, 2.0, 3.0, 4.0), 1e-12, 0.5, 0.25, 80.0, 2000.0, 1350.0)
    assert decode_reply(encode_reply(reply)) == reply
