"""One flight as text in many dialects and layouts: what people and tools write, and which profile that is."""

import gzip

import numpy as np
from scipy.spatial.transform import Rotation

N = 40
TIME = 0.02 * np.arange(N)
ANGLES = np.column_stack([40 + 30 * TIME, 14 * np.sin(TIME), 25 * np.sin(2 * TIME)])  # heading, pitch, bank [deg]
TRUTH = Rotation.from_euler("ZYX", ANGLES, degrees=True)
QUATERNION = TRUTH.as_quat(scalar_first=True)


def text(header: str, columns: list[np.ndarray], separator: str = ",", decimal: str = ".", end: str = "\n") -> str:
    rows = [
        separator.join(repr(float(cell)).replace(".", decimal) for cell in row) for row in zip(*columns, strict=True)
    ]
    return end.join([header, *rows, ""]) if header else end.join([*rows, ""])


HEADING = "time_s,heading_deg,pitch_deg,bank_deg"
EULER = [TIME, *ANGLES.T]
PLAIN = text(HEADING, EULER)
SEMICOLON = text(HEADING.replace(",", ";"), EULER, ";", ",")
W, X, Y, Z = QUATERNION.T
TUM_ROWS = text("", [TIME, TIME, TIME, TIME, X, Y, Z, W], " ")


def rows_of(*columns: list[str] | np.ndarray, separator: str = ",") -> str:
    cells = [[each if isinstance(each, str) else repr(float(each)) for each in column] for column in columns]
    return "".join(separator.join(row) + "\n" for row in zip(*cells, strict=True))


NANOSECONDS = [str(1_403_636_579_763_555_584 + 20_000_000 * k) for k in range(N)]
MICROSECONDS = [str(5_000_000 + 20_000 * k) for k in range(N)]
MILLISECONDS = [str(20 * k) for k in range(N)]
ZERO = ["0"] * N
H, P, B = ANGLES.T
RAD = np.radians(ANGLES).T

# Each is the flight: (its bytes, the profile that is found, the convention that is said).
FILES: dict[str, tuple[str | bytes, str, str | None]] = {
    "plain": (PLAIN, "fullpose-ned", "ned"),
    "plain without convention": (PLAIN, "fullpose-ned", None),
    "cr lf": (PLAIN.replace("\n", "\r\n"), "fullpose-ned", None),
    "no newline at the end": (PLAIN.rstrip("\n"), "fullpose-ned", None),
    "byte order mark": (PLAIN.encode("utf-8-sig"), "fullpose-ned", None),
    "byte order mark on line 2": ("# remark\n\ufeff" + PLAIN, "fullpose-ned", None),
    "blank of no width in the header": (PLAIN.replace("pitch", "\u200bpitch", 1), "fullpose-ned", None),
    "utf-16 with mark": (PLAIN.encode("utf-16"), "fullpose-ned", None),
    "utf-16-le": (PLAIN.encode("utf-16-le"), "fullpose-ned", None),
    "utf-16-be": (PLAIN.encode("utf-16-be"), "fullpose-ned", None),
    "utf-32": (PLAIN.encode("utf-32"), "fullpose-ned", None),
    "gb18030": (("# 飞行试验记录，第三架次\n" + PLAIN).encode("gb18030"), "fullpose-ned", None),
    "gb18030 header": (
        PLAIN.replace(HEADING, "时间,航向角,俯仰角,滚转角").encode("gb18030"),
        "heading-pitch-bank",
        "ned",
    ),
    "latin-1": ("# Flug über Köln\n".encode("latin-1") + PLAIN.encode(), "fullpose-ned", None),
    "gzip": (gzip.compress(PLAIN.encode()), "fullpose-ned", None),
    "gzip of utf-16": (gzip.compress(PLAIN.encode("utf-16")), "fullpose-ned", None),
    "semicolon, decimal comma": (SEMICOLON, "fullpose-ned", None),
    "semicolon, decimal point": (text(HEADING.replace(",", ";"), EULER, ";"), "fullpose-ned", None),
    "Excel's sep=": ("sep=;\n" + SEMICOLON, "fullpose-ned", None),
    "Excel's sep= with a mark": (("\ufeffsep=;\r\n" + SEMICOLON.replace("\n", "\r\n")).encode(), "fullpose-ned", None),
    "tabs": (text(HEADING.replace(",", "\t"), EULER, "\t"), "fullpose-ned", None),
    "tabs, decimal comma": (text(HEADING.replace(",", "\t"), EULER, "\t", ","), "fullpose-ned", None),
    "blanks": (text(HEADING.replace(",", "  "), EULER, "   "), "fullpose-ned", None),
    "blanks before and after": (
        text(HEADING.replace(",", " "), EULER, "  ").replace("\n", "  \n  "),
        "fullpose-ned",
        None,
    ),
    "bars": (text(HEADING.replace(",", " | "), EULER, " | "), "fullpose-ned", None),
    "comma and blank": (text(HEADING.replace(",", ", "), EULER, ", "), "fullpose-ned", None),
    "trailing commas": (PLAIN.replace("\n", ",\n"), "fullpose-ned", None),
    "trailing commas under the header alone": (
        PLAIN.replace("\n", ",\n").replace("deg,\n", "deg\n", 1),
        "fullpose-ned",
        None,
    ),
    "quotes": (PLAIN.replace(HEADING, '"time_s","heading_deg","pitch_deg","bank_deg"'), "fullpose-ned", None),
    "remarks": ("# one\n% two\n// three\n" + PLAIN, "fullpose-ned", None),
    "remarks between": (PLAIN.replace("\n0.2,", "\n# half-way\n0.2,"), "fullpose-ned", None),
    "plus signs": (PLAIN.replace(",4", ",+4"), "fullpose-ned", None),
    "unit row": (PLAIN.replace("deg\n", "deg\ns,deg,deg,deg\n", 1), "fullpose-ned", None),
    "unit row in brackets": (PLAIN.replace("deg\n", "deg\n[s],[deg],[deg],[deg]\n", 1), "fullpose-ned", None),
    "unit row in radians": (
        text("time,heading,pitch,bank\ns,rad,rad,rad", [TIME, *RAD]),
        "heading-pitch-bank",
        "ned",
    ),
    "unit row in milliseconds": (
        text("time,heading,pitch,bank\nms,deg,deg,deg", [1e3 * TIME, *ANGLES.T]),
        "heading-pitch-bank",
        "ned",
    ),
    "units in brackets": (
        text("Time [ms],Heading [rad],Pitch [rad],Bank [rad]", [1e3 * TIME, *RAD]),
        "heading-pitch-bank",
        "ned",
    ),
    "units in the names": (text("t_us,yaw_rad,pitch_rad,roll_rad", [1e6 * TIME, *RAD]), "heading-pitch-bank", "ned"),
    "centidegrees said": (
        text("time_s,heading [cdeg],pitch [cdeg],bank [cdeg]", [TIME, *(100 * ANGLES.T)]),
        "heading-pitch-bank",
        "ned",
    ),
    "a title before the header": ("Flight 12\nRecorded 2026-11-30\n" + PLAIN, "fullpose-ned", None),
    "yaw, pitch, roll under ned": (PLAIN.replace(HEADING, "time_s,yaw_deg,pitch_deg,roll_deg"), "fullpose", "ned"),
    "quaternion under ned": (text("time_s,qw,qx,qy,qz", [TIME, W, X, Y, Z]), "fullpose-quaternion", "ned"),
    "quaternion, w last": (text("time_s,qx,qy,qz,qw", [TIME, X, Y, Z, W]), "fullpose-quaternion", "ned"),
    "quaternion q0 to q3": (text("time,q0,q1,q2,q3", [TIME, W, X, Y, Z]), "quaternion-numbered", "ned"),
    "PX4 (ulog2csv)": (
        "timestamp,timestamp_sample,q[0],q[1],q[2],q[3],quat_reset_counter\n"
        + rows_of(MICROSECONDS, MICROSECONDS, W, X, Y, Z, ZERO),
        "px4",
        None,
    ),
    "ArduPilot (ATT)": (
        "timestamp,TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw\n"
        + rows_of(TIME, MICROSECONDS, ZERO, B, ZERO, P, ZERO, H),
        "ardupilot",
        None,
    ),
    "MAVLink ATTITUDE": (
        "time_boot_ms,roll,pitch,yaw,rollspeed,pitchspeed,yawspeed\n"
        + rows_of(MILLISECONDS, RAD[2], RAD[1], RAD[0], ZERO, ZERO, ZERO),
        "mavlink",
        None,
    ),
    "TUM": ("# timestamp tx ty tz qx qy qz qw\n" + TUM_ROWS, "tum", "ned"),
    "TUM without a header": (TUM_ROWS, "tum", "ned"),
    "EuRoC": (
        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n"
        + rows_of(NANOSECONDS, ZERO, ZERO, ZERO, W, X, Y, Z),
        "euroc",
        "ned",
    ),
    "VectorNav": ("TimeStartup,Yaw,Pitch,Roll\n" + rows_of(NANOSECONDS, H, P, B), "vectornav", None),
    "Xsens MT Manager": (
        "// Start Time: Unknown\n// Update Rate: 50.0Hz\n// Coordinate system: NED\n"
        "PacketCounter\tSampleTimeFine\tQuat_q0\tQuat_q1\tQuat_q2\tQuat_q3\n"
        + rows_of(MILLISECONDS, [f"{200 * k}" for k in range(N)], W, X, Y, Z, separator="\t"),
        "xsens",
        "ned",
    ),
    "Betaflight (blackbox_decode)": (
        "loopIteration, time (us), roll, pitch, heading\n" + rows_of(ZERO, MICROSECONDS, B, P, H),
        "betaflight",
        "ned",
    ),
    "JSBSim": (
        "Time,Altitude ASL (ft),Phi (deg),Theta (deg),Psi (deg)\n" + rows_of(TIME, ZERO, B, P, H),
        "jsbsim",
        None,
    ),
    "JSBSim properties": (
        "Time,/fdm/jsbsim/attitude/phi-rad,/fdm/jsbsim/attitude/theta-rad,/fdm/jsbsim/attitude/psi-rad\n"
        + rows_of(TIME, RAD[2], RAD[1], RAD[0]),
        "jsbsim-properties",
        None,
    ),
    "X-Plane (Data.txt)": (
        "  _real,_time |   _totl,_time |   pitch,__deg |   _roll,__deg |   hding,_true |   hding,__mag |\n"
        + rows_of(TIME, TIME, P, B, H, H, separator=" | ").replace("\n", " |\n"),
        "xplane",
        None,
    ),
    "FlightGear": (
        "Time,/orientation/heading-deg,/orientation/pitch-deg,/orientation/roll-deg\n" + rows_of(TIME, H, P, B),
        "flightgear",
        None,
    ),
    "ROS (rostopic echo -p)": (
        "%time,field.header.seq,field.header.stamp,field.orientation.x,field.orientation.y,field.orientation.z,"
        "field.orientation.w\n" + rows_of(NANOSECONDS, ZERO, NANOSECONDS, X, Y, Z, W),
        "ros",
        None,
    ),
    "ROS (PlotJuggler)": (
        "__time,/imu/orientation/w,/imu/orientation/x,/imu/orientation/y,/imu/orientation/z\n"
        + rows_of(TIME, W, X, Y, Z),
        "plotjuggler",
        None,
    ),
    "Simulink Data Inspector": (
        "time,yaw,pitch,roll\n,Type: double,Type: double,Type: double\n,Units: rad,Units: rad,Units: rad\n"
        + rows_of(TIME, RAD[0], RAD[1], RAD[2]),
        "heading-pitch-bank",
        "ned",
    ),
    "CCSDS AEM": (
        "CCSDS_AEM_VERS = 1.0\nCREATION_DATE = 2026-11-30T00:00:00\nORIGINATOR = X\nMETA_START\nOBJECT_NAME = A\n"
        "REF_FRAME_A = EME2000\nREF_FRAME_B = SC_BODY_1\nATTITUDE_DIR = A2B\nATTITUDE_TYPE = QUATERNION\n"
        "QUATERNION_TYPE = LAST\nMETA_STOP\nDATA_START\n"
        + rows_of([f"2026-11-30T12:00:{t:09.6f}" for t in TIME], X, Y, Z, W, separator=" ")
        + "DATA_STOP\n",
        "ccsds-aem",
        "ned",
    ),
    "CCSDS AEM, scalar first, body to reference, day of the year": (
        "CCSDS_AEM_VERS = 2.0\nMETA_START\nREF_FRAME_A = EME2000\nREF_FRAME_B = SC_BODY_1\nATTITUDE_DIR = B2A\n"
        "ATTITUDE_TYPE = QUATERNION\nQUATERNION_TYPE = FIRST\nMETA_STOP\nDATA_START\n"
        + rows_of([f"2026-334T12:00:{t:09.6f}" for t in TIME], W, -X, -Y, -Z, separator=" ")
        + "DATA_STOP\n",
        "ccsds-aem",
        "ned",
    ),
    "CCSDS AEM, Euler angles": (
        "CCSDS_AEM_VERS = 1.0\nMETA_START\nREF_FRAME_A = EME2000\nREF_FRAME_B = SC_BODY_1\nATTITUDE_DIR = A2B\n"
        "ATTITUDE_TYPE = EULER_ANGLE\nEULER_ROT_SEQ = 321\nMETA_STOP\nDATA_START\n"
        + rows_of([f"2026-11-30T12:00:{t:09.6f}" for t in TIME], B, P, H, separator=" ")
        + "DATA_STOP\n",
        "heading-pitch-bank",
        "ned",
    ),
    "STK": (
        f"stk.v.11.0\nBEGIN Attitude\nNumberOfAttitudePoints {N}\nScenarioEpoch 1 Jul 2026 12:00:00\n"
        "CoordinateAxes ICRF\nAttitudeTimeQuaternions\n" + rows_of(TIME, X, Y, Z, W, separator=" ") + "END Attitude\n",
        "stk",
        "ned",
    ),
    "STK, Euler angles": (
        "stk.v.11.0\nBEGIN Attitude\nSequence 321\nAttitudeTimeEulerAngles\n"
        + rows_of(TIME, H, P, B, separator=" ")
        + "END Attitude\n",
        "heading-pitch-bank",
        "ned",
    ),
    "NovAtel INSPVA": (
        "".join(
            f"#INSPVAA,COM1,0,31.0,FINESTEERING,1264,144088.000,02040000,5615,1541;1264,{144088 + t:.9f},51.1,-114.0,"
            f"401.1,354.8,108.4,-10.8,{b!r},{p!r},{h!r},INS_ALIGNMENT_COMPLETE*af719fd9\n"
            for t, h, p, b in zip(TIME, H.tolist(), P.tolist(), B.tolist(), strict=True)
        ),
        "novatel",
        None,
    ),
    "NovAtel INSPVAX": (
        "".join(
            f"#INSPVAXA,COM1,0,70.0,FINESTEERING,1943,{394672 + t:.6f},02000020,0ddd,1543;INS_SOLUTION_GOOD,INS_PSRSP,"
            f"51.1,-114.0,1061.1,-16.9,0.01,0.02,0.03,{b!r},{p!r},{h!r},0.1,0.1,0.1,0.1,0.1,0.1,0.1,0.1,0.1,3,0*66c\n"
            for t, h, p, b in zip(TIME, H.tolist(), P.tolist(), B.tolist(), strict=True)
        ),
        "novatel",
        None,
    ),
}
