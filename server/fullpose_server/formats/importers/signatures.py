"""What a file is by its first bytes: of those that are read and of those that are only named."""

PARQUET = b"PAR1"

# What is no flight, or none that is read: named for what it is.
_KNOWN: tuple[tuple[bytes, str], ...] = (
    (b"PK\x03\x04", "a ZIP archive (also .xlsx, .docx, .jar)"),
    (b"%PDF", "a PDF document"),
    (b"\x89PNG", "a PNG image"),
    (b"\xff\xd8\xff", "a JPEG image"),
    (b"GIF8", "a GIF image"),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file (also MATLAB 7.3)"),
    (b"MATLAB 5.0 MAT-file", "a MATLAB 5 file"),
    (b"TDSm", "a TDMS file"),
    (b"MDF     ", "an MDF measurement file"),
    (b"ULog\x01\x12\x35", "a PX4 ULog"),
    (b"\xa3\x95\x80", "an ArduPilot DataFlash log"),
    (b"\x89MCAP0\r\n", "an MCAP file"),
    (b"#ROSBAG V2.0", "a ROS 1 bag"),
    (b"SQLite format 3", "an SQLite database (also a ROS 2 bag)"),
    (b"BZh", "a bzip2 file"),
    (b"\xfd7zXZ\x00", "an xz file"),
    (b"\x28\xb5\x2f\xfd", "a Zstandard file"),
    (b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive"),
    (b"Rar!", "a RAR archive"),
    (b"\x1f\x8b", "a gzip file, and what is in it is no text"),
    (b"\xd0\xcf\x11\xe0", "an old Office file (.xls, .doc)"),
    (b"\x7fELF", "a program"),
    (b"MZ", "a program"),
    (b"\x93NUMPY", "a NumPy array"),
    (b"H Product:Blackbox", "a Betaflight blackbox log as it was recorded: blackbox_decode makes CSV of it"),
)


def name_of(head: bytes) -> str:
    """What a file that is not read is."""
    return next((name for start, name in _KNOWN if head.startswith(start)), "another binary file")
