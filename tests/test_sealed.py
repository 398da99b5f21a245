"""A sealed suite as a stranger meets it, and what a signature holds for."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from blake3_of import blake3_of_folder

import unshade as package
from conftest import HERE, QUICK, unshade

SUITE = """
format = 1
name = "sealed"
scene = "{scene}"
scales = ["global"]
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A round of one capture: ``out/public`` and ``out/private``."""
    place = tmp_path_factory.mktemp("sealed")
    (place / "secret").write_bytes(bytes(range(40)))
    (place / "suite.toml").write_text(SUITE.format(scene=HERE / "scenes" / "tiny-scene.toml"))
    said = unshade("seal", place / "suite.toml", "--seeds-from", place / "secret", "-o", place / "out").stdout
    assert "1 captures to publish" in said
    return place


@pytest.fixture(scope="module")
def submission(place: Path) -> Path:
    """What a stranger makes of the public folder alone."""
    folder = place / "submission"
    capture = package.Capture(place / "out" / "public" / "captures" / "tiny-studio")
    folder.mkdir()
    (folder / "submission.toml").write_text('format = 1\nname = "theirs"\nby = "a stranger"\n')
    (folder / "maps").mkdir()
    package.solve(capture, config=QUICK, out=folder / "maps" / "tiny-studio")
    return folder


@pytest.fixture(scope="module")
def scored(place: Path, submission: Path) -> Path:
    out = place / "scored"
    failed = package.score_submission(submission, place / "out" / "private", out, seeds_from=place / "secret")
    assert failed == {}
    return out


def test_a_stranger_finds_no_truth(place: Path) -> None:
    """Every file of the public folder is opened: no file of the truth, no hash of one, no seed, no withheld picture."""
    public, private = place / "out" / "public", place / "out" / "private"
    truth = private / "captures" / "tiny-studio" / "truth"
    scene = (truth / "scene.toml").read_text()
    seeds = [line.split("=")[1].strip() for line in scene.splitlines() if line.startswith("seed = ")]
    withheld = json.loads((truth.parent / "transforms.json").read_text())["test_filenames"]
    secrets = {path.read_bytes() for path in truth.rglob("*") if path.is_file()}
    secrets |= {(truth.parent / name).read_bytes() for name in withheld}
    words = [seed.encode() for seed in seeds if len(seed) > 4] + [blake3_of_folder(truth.parent).encode(), b"truth"]
    words += [blake3_of_folder(path).encode() for path in truth.rglob("*") if path.is_file()]
    # Two seeds of the secret: the face's and the noise's.
    assert sum(len(seed) > 4 for seed in seeds) == 2
    found = [path for path in public.rglob("*") if path.is_file()]
    assert len(found) >= 12
    for path in found:
        content = path.read_bytes()
        assert content not in secrets, path
        assert not [word for word in words if word in content], path
    assert not [path for path in public.rglob("*") if path.name == "truth" or path.is_symlink()]
    # What is there can be solved, but not scored here.
    assert package.Capture(public / "captures" / "tiny-studio").path
    suite = public.parent / "suite.toml"
    suite.write_text('format = 1\nname = "s"\ncaptures = ["public/captures/tiny-studio"]\n[[method]]\nname = "fast"\n')
    done = unshade("run", suite, "-o", public.parent / "run", check=False)
    assert done.returncode == 2 and "suite.toml:3: captures: " in done.stderr and "hand them in" in done.stderr


def test_the_faces_are_the_secrets_own(place: Path, tiny_run: Path) -> None:
    """Not those of the suite's file, whose seeds everybody knows."""
    name = Path("captures") / "tiny-studio" / "truth" / "diffuse_albedo.exr"
    known, sealed = (
        package.Capture(root / name.parent.parent).truth() for root in (tiny_run, place / "out" / "private")
    )
    assert np.abs(known.diffuse_albedo - sealed.diffuse_albedo).max() > 0.05


def test_a_submission_is_accepted_scored_and_signed(place: Path, submission: Path, scored: Path) -> None:
    public = place / "out" / "public"
    assert "accepted, 1 of 1" in unshade("check", "--submission", submission, "--captures", public).stdout
    assert "accepted, 1 of 1" in unshade("check", "--submission", scored).stdout
    scores = json.loads((scored / "scores" / "tiny-studio" / "theirs.json").read_text())
    relit = [row for row in scores["rows"] if row["subject"] == "relit" and row["metric"] == "psnr_srgb"]
    assert scores["solver"] == "theirs" and relit and all(row["value"] > 15 for row in relit)
    key = json.loads((public / "round.json").read_text())["public_key"]
    assert "theirs by a stranger" in unshade("verify", scored, "--key", key).stdout
    assert package.verify(scored) == key
    statement = json.loads((scored / "statement.json").read_text())
    assert statement["maps"] == {"tiny-studio": blake3_of_folder(submission / "maps" / "tiny-studio")}
    assert statement["captures"] == {"tiny-studio": blake3_of_folder(public / "captures" / "tiny-studio")}
    # And stands in a leaderboard.
    unshade("site", scored, "-o", place / "site")
    assert '"name":"theirs"' in (place / "site" / "leaderboard.json").read_text()


@pytest.mark.parametrize("name", ["scores/tiny-studio/theirs.json", "run.json", "statement.json", "signature.json"])
def test_a_changed_byte_breaks_the_signature(scored: Path, tmp_path: Path, name: str) -> None:
    forged = shutil.copytree(scored, tmp_path / "forged")
    text = (forged / name).read_text()
    (forged / name).write_text(text.replace("1", "2", 1))
    assert text != (forged / name).read_text()
    done = unshade("verify", forged, check=False)
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    refused = unshade("check", "--submission", forged, check=False)
    assert refused.returncode == 1


def test_seal_refuses_settings_that_scoring_ignores(place: Path, tmp_path: Path) -> None:
    suite = tmp_path / "suite.toml"
    suite.write_text((place / "suite.toml").read_text().replace("scales", 'lpips = "alex"\nscales'))
    words = ["--seeds-from", place / "secret", "-o", tmp_path / "out"]
    done = unshade("seal", suite, *words, check=False)
    assert done.returncode == 2 and "suite.toml:5: lpips: a round is scored without" in done.stderr, done.stderr
    assert not (tmp_path / "out").exists()


def test_another_key_or_secret_is_refused(place: Path, submission: Path, scored: Path, tmp_path: Path) -> None:
    done = unshade("verify", scored, "--key", "ab" * 32, check=False)
    assert done.returncode == 2 and "is signed by" in done.stderr
    done = unshade("verify", place, check=False)
    assert done.returncode == 2 and "is not signed" in done.stderr
    (tmp_path / "secret").write_bytes(b"x" * 32)
    words = ["--score", submission, "--private", place / "out" / "private", "--seeds-from", tmp_path / "secret"]
    done = unshade("seal", *words, "-o", tmp_path / "scored", check=False)
    assert done.returncode == 2 and "another secret" in done.stderr and not (tmp_path / "scored").exists()
    (tmp_path / "secret").write_bytes(b"password")
    done = unshade(
        "seal", place / "suite.toml", "--seeds-from", tmp_path / "secret", "-o", tmp_path / "out", check=False
    )
    assert done.returncode == 2 and "32 bytes" in done.stderr


def test_submission_check_names_each_fault(place: Path, submission: Path, tmp_path: Path) -> None:
    public = place / "out" / "public"
    broken = shutil.copytree(submission, tmp_path / "broken")
    shutil.rmtree(broken / "maps" / "tiny-studio")
    (broken / "submission.toml").write_text('format = 1\nname = "my method"\nby = "x"\n')
    done = unshade("check", "--submission", broken, "--captures", public, check=False)
    assert done.returncode == 1
    assert "is missing" in done.stdout and "cannot name a folder" in done.stdout
    # Whoever guesses where the truth lies gets nothing by a link to it.
    linked = shutil.copytree(submission, tmp_path / "linked")
    albedo = linked / "maps" / "tiny-studio" / "diffuse_albedo.exr"
    albedo.unlink()
    albedo.symlink_to(place / "out" / "private" / "captures" / "tiny-studio" / "truth" / "diffuse_albedo.exr")
    done = unshade("check", "--submission", linked, "--captures", public, check=False)
    assert done.returncode == 1 and "diffuse_albedo.exr: is a link" in done.stdout
    words = ["--score", linked, "--private", place / "out" / "private", "--seeds-from", place / "secret"]
    done = unshade("seal", *words, "-o", tmp_path / "scored", check=False)
    assert done.returncode == 2 and "is a link" in done.stderr
    other = shutil.copytree(public, tmp_path / "public")
    mask = next((other / "captures" / "tiny-studio" / "masks").iterdir())
    mask.write_bytes(mask.read_bytes() + b"x")
    done = unshade("check", "--submission", submission, "--captures", other, check=False)
    assert done.returncode == 1 and "is not the capture that was handed out" in done.stdout
