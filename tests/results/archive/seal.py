"""The seal at the end of an archive, made as docs/file_format.md says and not by the program."""

import hashlib
import pathlib

SEAL_BYTES = 82


def seal(path):
    """Seals a file that h5py has changed, which has cut the old seal off."""
    content = pathlib.Path(path).read_bytes()
    digits = hashlib.sha256(content).hexdigest()
    pathlib.Path(path).write_bytes(content + f"\nmpmbench sha256 {digits}\n".encode("ascii"))


def is_sealed(path):
    content = pathlib.Path(path).read_bytes()
    digits = hashlib.sha256(content[:-SEAL_BYTES]).hexdigest()
    return content[-SEAL_BYTES:] == f"\nmpmbench sha256 {digits}\n".encode("ascii")
