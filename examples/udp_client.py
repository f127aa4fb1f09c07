"""A live source in plain UDP: a swing about all axes, 500 samples a second. Nothing but the standard library.

    FULLPOSE_LIVE_UDP_PORTS='{"vertical-4": 7460}' fullpose serve     # then load the live source, arm, go live
    python examples/udp_client.py [port [seconds [key]]]

`key` is what the load was answered: each datagram is coded with it. Without, load with the address printed here.
The datagrams are in docs/guide/live.md. The last reply a second is printed.
"""

import hmac
import math
import socket
import struct
import sys
import time

port = int(sys.argv[1]) if len(sys.argv) > 1 else 7460
seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 10.0
key = sys.argv[3].encode() if len(sys.argv) > 3 else None
link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
link.bind(("127.0.0.1", 7461 if key is None else 0))
link.connect(("127.0.0.1", port))
print("udp_from: {}:{}".format(*link.getsockname()))
link.settimeout(0.002)
rates = (math.nan,) * 3  # we have none: they are estimated
begun, told = time.monotonic(), 0
first = time.time_ns()  # the sequence rises over restarts: what was coded with a key counts once
for k in range(int(seconds * 500)):
    t = time.monotonic() - begun
    ramp = min(1.0, t / 3.0) ** 2
    yaw, pitch, roll = (ramp * a * math.sin(w * t) for a, w in ((30, 0.7), (15, 1.1), (40, 0.9)))
    sample = struct.pack("<4sIQd4d3d", b"FPA1", 2, first + k, t, yaw, pitch, roll, 0.0, *rates)
    link.send(sample if key is None else sample + hmac.digest(key, sample, "sha256")[:16])
    try:
        _, status, _, _, *n = struct.unpack("<4sIQd4d4d2d", link.recv(104))
    except TimeoutError:
        continue
    time.sleep(max(0.0, begun + 0.002 * (k + 1) - time.monotonic()))
    if int(t) > told:
        told = int(t)
        print(f"{told} s  status {status}  angles {n[0]:.2f} {n[1]:.2f} {n[2]:.2f} {n[3]:.2f}  error {n[4]:.1e} deg")
