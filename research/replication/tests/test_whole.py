"""What is written is whole, or as it was."""

import pytest

from research.replication.whole import write_whole


def test_a_text_that_cannot_be_written_leaves_the_file_as_it_was(tmp_path):
    path = tmp_path / "page.md"
    write_whole(path, "ΔE, whole\n")
    with pytest.raises(UnicodeEncodeError):
        write_whole(path, "half of it, then no text: \ud800")
    assert path.read_text(encoding="utf-8") == "ΔE, whole\n"
    assert list(tmp_path.iterdir()) == [path]
