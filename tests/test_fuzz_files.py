"""The fuzzer of files: every reader answers mutated files, and a planted defect is found."""

from fuzz import files


def test_every_reader_reads_or_refuses_mutated_files(capsys):
    assert files.main(["--seed", "3", "--files", "10"]) == 0
    said = capsys.readouterr().out.splitlines()
    assert len(said) == 13
