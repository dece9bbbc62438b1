"""File names in URDF: relative to the file, absolute, file://, or package:// with the package.xml above the file."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import unquote
from xml.etree import ElementTree

from fixture_design.errors import FileFormatError, UnsupportedError


def resolve(name: str, urdf: Path, place: str) -> Path:
    """The file that a name in a URDF means; whether it exists is for its reader to say.

    ``package://robot/meshes/a.stl`` is sought from the folders above the URDF file whose package.xml says ``robot``,
    from those that are called ``robot``, and from folders called ``robot`` that lie next to one of them.

    Raises:
        FileFormatError: no name, a package that is not there, a package.xml that cannot be read.
        UnsupportedError: http:// and other schemes.
    """
    if not name.strip():
        raise FileFormatError("a mesh has no filename", source=urdf, place=place)
    scheme, separator, rest = name.partition("://")
    if not separator:
        return urdf.parent / name
    if scheme == "file":
        return Path(unquote(rest))
    if scheme not in ("package", "model"):
        raise UnsupportedError(f"cannot fetch {name!r}", source=urdf, place=place, expected="a file name or package://")
    package, _, path = rest.partition("/")
    for folder in urdf.resolve().parents:
        if _package_name(folder) == package or folder.name == package:
            return folder / path
        if _is_folder(folder / package):
            return folder / package / path
    raise FileFormatError(
        f"there is no package {package!r:.200}",
        source=urdf,
        place=place,
        expected="a package.xml with that <name> in a folder above the file",
    )


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except OSError:  # a name longer than any folder's
        return False


def _package_name(folder: Path) -> str | None:
    """The name in the folder's package.xml, None without one or if it names nothing."""
    file = folder / "package.xml"
    if not file.is_file():
        return None
    try:
        name = ElementTree.parse(file).getroot().findtext("name")
    except ElementTree.ParseError as cause:
        raise FileFormatError("not XML", source=file, found=str(cause), expected="a ROS package.xml") from cause
    except (LookupError, ValueError) as cause:  # an encoding that Python or its XML parser does not know
        raise FileFormatError("not XML", source=file, place="line 1", found=str(cause), expected="UTF-8") from cause
    except OSError as cause:
        raise FileFormatError(f"the file cannot be read ({cause.strerror or cause})", source=file) from cause
    return name.strip() if name else None
