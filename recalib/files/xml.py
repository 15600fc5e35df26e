"""XML in whichever encoding it declares."""

import codecs
import re
from pathlib import Path
from xml.etree import ElementTree

from recalib.errors import InvalidFile

_DECLARED = re.compile(rb"""\s*<\?xml[^>]*?\sencoding\s*=\s*["']([\w.-]+)["']""")
_MARKED = dict.fromkeys((codecs.BOM_UTF16_LE, b"<\0"), "utf-16-le")
_MARKED |= dict.fromkeys((codecs.BOM_UTF16_BE, b"\0<"), "utf-16-be")


def encoding(source: bytes) -> str:
    """The encoding of XML: what its first bytes mark or declare, or else UTF-8."""
    if declared := _DECLARED.match(source):
        return declared[1].decode("ascii")
    return _MARKED.get(source[:2], "utf-8")


def read_xml(source: bytes, path: Path) -> ElementTree.Element:
    """The root of XML; its path is for messages.

    Raises InvalidFile: not XML, with line and column; or in another encoding than it declares.
    """
    try:
        text = source.decode(encoding(source))
        if text.encode(encoding(source)) != source:  # a corrected one could not keep its bytes
            raise UnicodeError
        return ElementTree.fromstring(text)
    except (LookupError, UnicodeError):
        raise InvalidFile(path, f"its text is not in {encoding(source)}") from None
    except ElementTree.ParseError as error:
        words, line, column = str(error).partition(":")[0], *error.position
        reason = f"it is not XML: line {line}, column {column}: {words}"
        raise InvalidFile(path, reason) from None
