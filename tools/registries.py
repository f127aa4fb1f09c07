"""How this machine's pip or npm reaches its registry, as a file of settings for a container's build.

    python3 tools/registries.py pip|npm [CA]

What only makes sense on this machine stays out: folders, caches, constraints. CA is where the build has the machine's
CA bundle. It runs before there is an environment: nothing but the standard library.
"""

import json
import subprocess
import sys

PIP = ("index-url", "extra-index-url", "trusted-host", "proxy", "timeout", "default-timeout", "retries")
NPM = ("registry", "proxy", "https-proxy", "strict-ssl")


def pip(ca: str) -> str:
    """pip.conf, from all of pip's own files and variables."""
    said = subprocess.run([sys.executable, "-m", "pip", "config", "list"], capture_output=True, text=True, check=True)
    lines = ["[global]", *([f"cert = {ca}"] if ca else [])]
    for line in said.stdout.splitlines():
        name, _, value = line.partition("=")
        key = name.rsplit(".", 1)[-1]
        value = " ".join(word for word in value.strip("'\"").split() if not word.startswith("file:"))
        if key in PIP and value:
            lines.append(f"{key.removeprefix('default-')} = {value}")
    return "\n".join(lines)


def npm(ca: str) -> str:
    """npmrc: the registry, its credentials are not looked for."""
    said = subprocess.run(["npm", "config", "list", "--json"], capture_output=True, text=True, check=True)
    known = json.loads(said.stdout)
    lines = [f"cafile={ca}"] if ca else []
    lines += [f"{key}={json.dumps(known[key])}" for key in NPM if known.get(key) not in (None, "")]
    return "\n".join(lines)


def main() -> int:
    """Print it; 1 where the tool is not there."""
    try:
        print({"pip": pip, "npm": npm}[sys.argv[1]]("".join(sys.argv[2:])))
    except (FileNotFoundError, subprocess.CalledProcessError):
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
