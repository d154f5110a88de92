"""What scenes depend on besides their trees."""
import hashlib
from pathlib import Path

# Of the addon: what a baked tree is made by and of.
PARTS = ("baking", "bin", "nodes", "presets", "shaders", "textures")


def of_baker(project, workflows):
    """A digest of the addon in a project, and of the script that has it bake."""
    addon = Path(project) / "addons" / "tree_reconstruction"
    files = [path for part in PARTS for path in (addon / part).rglob("*") if path.is_file()]
    # Of the libraries the editor's is at work; what lies beside pictures is made by the import.
    files = [path for path in files if path.suffix != ".import" and "template" not in path.name]
    files.append(Path(workflows) / "engine" / "bake.gd")
    digest = hashlib.sha256()
    for path in sorted(files):
        digest.update(path.name.encode() + b"\0" + hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()
