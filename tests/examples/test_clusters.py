"""The files that start clusters: they fit together, and a run by the one for ssh is the same run."""

import filecmp
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "examples" / "clusters"


def test_what_stands_on_kubernetes_finds_each_other():
    """Selectors, claims and addresses name what the same file makes; all stand in the policy."""
    yaml = pytest.importorskip("yaml")
    made = list(yaml.safe_load_all((FOLDER / "kubernetes.yaml").read_text("utf-8")))
    kinds = {(one["kind"], one["metadata"]["name"]): one for one in made}
    assert len(kinds) == len(made) == 6
    pods = {
        name: one["spec"]["template"]
        for (kind, name), one in kinds.items()
        if kind in {"Deployment", "Job"}
    }
    ours = kinds["NetworkPolicy", "only-ours"]["spec"]["podSelector"]["matchLabels"]
    for name, pod in pods.items():
        labels = pod["metadata"]["labels"]
        assert ours.items() <= labels.items()
        (container,) = pod["spec"]["containers"]
        assert container["image"] == "trundle:latest"
        mounts = {mount["name"] for mount in container.get("volumeMounts", [])}
        assert mounts == {volume["name"] for volume in pod["spec"].get("volumes", [])}
        if ("Deployment", name) in kinds:
            wanted = kinds["Deployment", name]["spec"]["selector"]["matchLabels"]
            assert wanted.items() <= labels.items()
    service = kinds["Service", "scheduler"]["spec"]
    assert service["selector"].items() <= pods["scheduler"]["metadata"]["labels"].items()
    (port,) = service["ports"]
    for name in ("worker", "run"):
        command = pods[name]["spec"]["containers"][0]["command"]
        assert f"tcp://scheduler:{port['port']}" in command
    volumes = {v["name"]: v for v in pods["run"]["spec"]["volumes"]}
    claim = volumes["results"]["persistentVolumeClaim"]["claimName"]
    assert ("PersistentVolumeClaim", claim) in kinds


def test_the_image_takes_what_there_is():
    """Each file copied is in the repository, and each extra in the project's list."""
    text = (FOLDER / "Dockerfile").read_text("utf-8")
    for line in re.findall(r"(?m)^COPY (.+) \S+$", text):
        assert all((ROOT / name).exists() for name in line.split())
    (extras,) = re.findall(r"/build\[(.+?)\]", text)
    project = (ROOT / "pyproject.toml").read_text("utf-8")
    assert all(re.search(rf"(?m)^{name} = \[", project) for name in extras.split(","))


def test_the_script_for_slurm_explains_itself():
    """Without dask-jobqueue, which is no extra of the project."""
    told = subprocess.run(
        [sys.executable, FOLDER / "slurm.py", "--help"], capture_output=True, text=True, check=True
    )
    for option in ("--jobs", "--cpus", "--memory", "--show"):
        assert option in told.stdout


def test_the_script_for_ssh_asks_for_hosts():
    told = subprocess.run(
        ["sh", FOLDER / "ssh.sh", "study.toml"], capture_output=True, text=True, check=False
    )
    assert told.returncode == 2
    assert "HOST" in told.stderr


@pytest.mark.longest
def test_a_run_by_the_script_for_ssh_is_the_same_run(tmp_path, trundle):
    """Two workers on this machine, a scheduler on loopback; the same numbers as by threads."""
    pytest.importorskip("distributed")
    study = ROOT / "scripts" / "small_study.toml"
    said = os.environ | {
        "TRUNDLE_BIN": str(Path(sys.executable).parent),
        "SCHEDULER_HOST": "127.0.0.1",
        "SCHEDULER_PORT": str(20000 + os.getpid() % 20000),
        "TRUNDLE_OPTIONS": f"--out {tmp_path / 'there'} --yes --quiet",
    }
    subprocess.run(
        ["sh", FOLDER / "ssh.sh", study, "localhost", "localhost"],
        env=said, check=True, timeout=600, stdin=subprocess.DEVNULL,
    )  # fmt: skip
    assert trundle("run", study, "--out", tmp_path / "here", "--yes", "--quiet") == 0
    for name in ("summary.csv", "verdicts.csv"):
        assert filecmp.cmp(tmp_path / "here" / name, tmp_path / "there" / name, shallow=False)
