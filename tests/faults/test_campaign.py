"""A slice of the campaign of faults; FAULT_ROUNDS sets how many rounds of it."""

import os
from pathlib import Path

from tests.faults.campaign import DISK_KB, rounds
from tests.faults.laboratory import Laboratory
from tests.support.disks import small_disk

ROUNDS = int(os.environ.get("FAULT_ROUNDS", "5"))


def test_whatever_fails_limits_are_kept_and_the_server_is_up_again(tmp_path: Path) -> None:
    with small_disk(tmp_path / "disk", DISK_KB) as data, Laboratory(data) as lab:
        for done in rounds(lab, 17, range(ROUNDS)):
            assert done.failed is None, done.failed
