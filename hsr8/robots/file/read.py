"""Reading of model files: MJCF or URDF as a MuJoCo model whose bodies and joints all have names."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from hsr8.errors import ModelError
from hsr8.robots.file.files import reading_models
from hsr8.robots.file.key_mistake import label
from hsr8.robots.file.meshes import is_pointer
from hsr8.robots.file.urdf import drop_invalid_meshes, read_urdf

MIN_STEP = 1e-5  # of the physics [s]
MAX_OFFSET = 5.0  # of a body from the one that carries it [m]

if mujoco.get_mju_user_warning() is None:  # MuJoCo would write a log into the working folder
    mujoco.set_mju_user_warning(lambda _message: None)


@dataclass(frozen=True, slots=True, eq=False)
class ModelFile:
    """Model of a file.

    Attributes:
        file: MJCF or URDF file.
        spec: MuJoCo model.
        speed: maximum speed of the joints that state one [rad/s].
        notes: notes on parts that are left out, a line each.
    """

    file: Path
    spec: mujoco.MjSpec
    speed: Mapping[str, float]
    notes: tuple[str, ...]

    @property
    def is_urdf(self) -> bool:
        """Whether the file is a URDF file."""
        return self.file.suffix.lower() == ".urdf"


def read_spec(file: Path, packages: Mapping[str, Path]) -> ModelFile:
    """Read a model file.

    Bodies and joints without a name get one, such as ``body_7``.

    Args:
        file: MJCF or URDF file.
        packages: folders of the packages that a URDF file names.

    Raises:
        ModelError: the file cannot be read, or has no joints.
    """
    speed, notes = dict[str, float](), list[str]()
    if file.suffix.lower() == ".urdf":
        spec, speed, notes = read_urdf(file, packages)
    else:
        with reading_models(str(file)):
            spec = _mjcf(file)
        _name_parts(spec)
        _check_meshes(spec, file)
    if not spec.joints:
        raise ModelError(f"{file}: the model has no joints; expected a robot")
    return ModelFile(file, spec, speed, tuple(notes))


def _mjcf(file: Path) -> mujoco.MjSpec:
    """Read an MJCF file, also one with a suffix that MuJoCo does not know."""
    if file.suffix.lower() == ".xml":
        return mujoco.MjSpec.from_file(str(file))
    spec = mujoco.MjSpec.from_string(file.read_text())
    spec.modelfiledir = str(file.parent)
    return spec


def _check_meshes(spec: mujoco.MjSpec, file: Path) -> None:
    """Refuse mesh files that Git has not fetched.

    Raises:
        ModelError: a mesh file is a pointer of Git LFS.
    """
    for mesh in spec.meshes:
        path = Path(spec.modelfiledir) / spec.meshdir / mesh.file
        if mesh.file and path.is_file() and is_pointer(path):
            raise ModelError(
                f"{file}: mesh {mesh.file!r}: got a pointer of Git LFS; expected the mesh: fetch "
                "it with `git lfs pull`"
            )


def drop_drawn_meshes(spec: mujoco.MjSpec, kept: Collection[str]) -> None:
    """Remove meshes that are only drawn, which take most of the time of compilation.

    Args:
        spec: specification, changed in place.
        kept: bodies whose meshes remain, also on those fixed to them.

    Raises:
        ModelError: the file of a removed mesh is missing.
    """
    kinds = mujoco.mjtInertiaFromGeom
    if spec.compiler.inertiafromgeom == kinds.mjINERTIAFROMGEOM_TRUE:
        return
    used = set()
    for geom in [g for g in spec.geoms if g.type == mujoco.mjtGeom.mjGEOM_MESH]:
        body = geom.parent
        weighs = not body.explicitinertial and (
            spec.compiler.inertiafromgeom != kinds.mjINERTIAFROMGEOM_FALSE
        )
        while body.name not in kept and body.parent is not None and not body.joints:
            body = body.parent
        if geom.contype or geom.conaffinity or weighs or body.name in kept:
            used.add(geom.meshname)
        else:
            spec.delete(geom)
    for mesh in [mesh for mesh in spec.meshes if mesh.name not in used]:
        folder = Path(spec.modelfiledir) / spec.meshdir
        if mesh.file and not (folder / mesh.file).is_file():
            raise ModelError(
                f"{spec.modelname}: mesh {mesh.name!r}: missing, got {mesh.file!r}; expected a file"
            )
        spec.delete(mesh)


def compile_spec(source: ModelFile, spec: mujoco.MjSpec) -> tuple[mujoco.MjModel, list[str]]:
    """Compile a model; return notes on the meshes of a URDF file that are left out.

    Args:
        source: file of the model.
        spec: cannot be changed afterwards in reasonable time.

    Raises:
        ModelError: MuJoCo cannot compile it, or a number is not that of a robot.
    """
    notes: list[str] = []
    with reading_models(str(source.file)):
        try:
            model = spec.compile()
        except ValueError:
            if not source.is_urdf:
                raise
            notes = drop_invalid_meshes(spec)
            model = spec.compile()
        _check_numbers(model)
    return model, notes


def _check_numbers(model: mujoco.MjModel) -> None:
    """Refuse numbers that MuJoCo compiles although they are not those of a robot."""
    step = float(model.opt.timestep)
    if not step >= MIN_STEP:
        raise ValueError(f"option: timestep, got {step:g} s; expected at least {MIN_STEP:g}")
    bodies = [f"body {label(model.body(b).name, b)!r}" for b in range(model.nbody)]
    joints = [f"joint {label(model.joint(j).name, j)!r}" for j in range(model.njnt)]
    dofs = [joints[j] for j in model.dof_jntid]
    geoms = [f"geom {label(model.geom(g).name, g)!r}" for g in range(model.ngeom)]
    servos = [f"actuator {label(model.actuator(a).name, a)!r}" for a in range(model.nu)]
    for names, kind, keys in (
        (bodies, "body", ("pos", "quat", "ipos")),
        (joints, "jnt", ("pos", "axis", "range", "stiffness")),
        (dofs, "dof", ("damping", "armature", "frictionloss")),
        (geoms, "geom", ("size", "friction")),
        (servos, "actuator", ("gainprm", "forcerange")),
    ):
        for key in keys:
            rows = np.atleast_2d(getattr(model, f"{kind}_{key}").T).T
            for name, values in zip(names, rows, strict=True):
                got = " ".join(f"{value:g}" for value in values)
                if not np.isfinite(values).all():
                    raise ValueError(f"{name}: {key}, got {got}; expected finite numbers")
                if (kind == "dof" or key == "stiffness") and values.min() < 0.0:
                    raise ValueError(f"{name}: {key}, got {got}; expected >= 0")
    for body in range(1, model.nbody):
        distance = float(np.abs(model.body_pos[body]).max())
        if model.body_parentid[body] and distance > MAX_OFFSET:
            raise ValueError(
                f"{bodies[body]}: {distance:g} m from the body that carries it; expected at most "
                f"{MAX_OFFSET:g}"
            )


def _name_parts(spec: mujoco.MjSpec) -> None:
    """Name the bodies and the hinge joints that have no name."""
    for kind, parts in (("body", spec.bodies), ("joint", spec.joints)):
        names = {part.name for part in parts}
        for number, part in enumerate(parts):
            if not part.name and getattr(part, "type", None) != mujoco.mjtJoint.mjJNT_FREE:
                name = f"{kind}_{number}"
                part.name = name if name not in names else f"unnamed_{name}"
