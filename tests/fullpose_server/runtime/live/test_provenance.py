"""What proves a datagram to be of the source that was loaded, and what does not."""

import pytest

from fullpose_server.runtime.live.packets import Kind, encode_sample
from fullpose_server.runtime.live.provenance import CODE_SIZE, Address, Provenance, coded, digest_of
from fullpose_server.runtime.live.settings import LiveError, LiveSettings

HERE, THERE = ("127.0.0.1", 7461), ("127.0.0.1", 7462)
LOCAL = "a name of the local socket"


def sample(sequence: int = 0) -> bytes:
    return encode_sample(Kind.QUATERNION, sequence, 0.1 * sequence, (1.0, 0.0, 0.0, 0.0), ())


def test_without_key_and_address_nothing_is_proven() -> None:
    nothing = Provenance()
    for datagram in (sample(), coded(sample(), ""), sample() + digest_of("")):
        for sender in (HERE, LOCAL, None, b""):
            assert not nothing.proves(datagram, sender)


def test_by_the_local_socket_the_digest_of_the_key_proves() -> None:
    source = Provenance("key")
    assert source.proves(sample() + digest_of("key"), LOCAL)
    assert source.proves(sample() + digest_of("key"), None)
    for datagram in (sample(), sample() + digest_of("another"), coded(sample(), "key")):
        assert not source.proves(datagram, LOCAL)
    assert not source.proves(sample() + digest_of("key"), HERE)  # that is no secret on a network


def test_by_udp_a_code_of_the_key_proves_once() -> None:
    source = Provenance("key")
    heard = [coded(sample(k), "key") for k in range(5)]
    assert [source.proves(datagram, HERE) for datagram in heard] == [True] * 5
    assert [source.proves(datagram, THERE) for datagram in heard] == [False] * 5  # heard before, and sent again
    assert source.proves(coded(sample(9), "key"), THERE)  # from wherever
    for k, datagram in enumerate((sample(10), coded(sample(11), "another"), coded(sample(12), "key")[:-1] + b"x")):
        assert not source.proves(datagram, HERE), k
    bent = bytearray(coded(sample(13), "key"))
    bent[30] ^= 1
    assert not source.proves(bytes(bent), HERE)
    assert source.proves(coded(sample(10), "key"), HERE)  # what was not proven does not count as heard
    assert len(coded(sample(), "key")) == len(sample()) + CODE_SIZE == 96


def test_a_later_load_has_a_key_of_its_own() -> None:
    assert not Provenance("second").proves(coded(sample(), "first"), HERE)


def test_by_udp_the_named_address_proves() -> None:
    source = Provenance(None, Address(*HERE))
    assert source.proves(sample(), HERE)
    assert not source.proves(sample(), THERE)
    assert not source.proves(sample(), ("127.0.0.2", HERE[1]))
    assert not source.proves(sample(), LOCAL)


def test_an_address_is_read_or_refused() -> None:
    assert LiveSettings(udp_from="127.0.0.1:7461").address == HERE
    assert LiveSettings().address is None
    for wrong in ("127.0.0.1:99999", "127.0.0.1:0", "7461", "localhost:7461", "127.0.0.1", "127.0.0.1:", "1.2.3:4"):
        with pytest.raises(LiveError, match="expected an IPv4 address and a port"):
            _ = LiveSettings(udp_from=wrong).address
