"""HSR-VIII with ankles that two parallel rods drive, as those of recent robots.

Two cranks on each shank turn about the left axis, and rods with ball joints lead from their ends to
the foot. At zero angles cranks and foot are parallel, so that pitch turns both cranks alike, and
roll turns them against each other, in proportion `WIDTH` / `ARM`.
"""

from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from hsr8.robots.file.files import models_dir

ARM, WIDTH, ROD = 0.02, 0.02, 0.06  # of a crank, of the feet of the rods, and of a rod [m]
STIFFNESS, DAMPING, TORQUE = 30.0, 0.3, 3.0  # of a crank's servo
FEET = ("l_foot_link", "r_foot_link")


def rod_legs(actuator: str = "position") -> Element:
    """MJCF of the robot; the cranks have position servos or motors."""
    file = models_dir() / "hsr8" / "hsr8.xml"
    root = ElementTree.fromstring(file.read_bytes())
    for keyframes in root.findall("keyframe"):
        root.remove(keyframes)
    closing, actuators = SubElement(root, "equality"), root.find("actuator")
    for servo in list(actuators):
        if "ankle" in servo.get("joint", ""):
            actuators.remove(servo)
    for side in "lr":
        shank = next(b for b in root.iter("body") if b.get("name") == f"{side}_knee_link")
        for k, y in enumerate((WIDTH, -WIDTH)):
            name = f"{side}_crank_{k}"
            crank = SubElement(shank, "body", name=name, pos=f"0 {y} {-0.105 + ROD}")
            SubElement(crank, "joint", name=name, axis="0 1 0", armature="0.001", damping="0.01")
            inertia = {"mass": "0.004", "diaginertia": "1e-6 1e-6 1e-6"}
            SubElement(crank, "inertial", pos=f"{-0.5 * ARM} 0 0", **inertia)
            rod = SubElement(crank, "body", name=f"{side}_rod_{k}", pos=f"{-ARM} 0 0")
            SubElement(rod, "joint", name=f"{side}_rod_{k}", type="ball")
            SubElement(rod, "inertial", pos=f"0 0 {-0.5 * ROD}", **inertia)
            anchor = {"anchor": f"0 0 {-ROD}", "solref": "0.004 1"}
            ends = {"body1": f"{side}_rod_{k}", "body2": f"{side}_foot_link"}
            SubElement(closing, "connect", name=f"{side}_rod_{k}", **ends, **anchor)
            gains = {"kp": str(STIFFNESS), "kv": str(DAMPING)} if actuator == "position" else {}
            limits = {"forcerange": f"{-TORQUE} {TORQUE}"}
            SubElement(actuators, actuator, name=name, joint=name, **gains, **limits)
    return root


def write(folder: Path, actuator: str = "position") -> Path:
    """Write the model."""
    file = folder / "rods.xml"
    file.write_text(ElementTree.tostring(rod_legs(actuator), "unicode"))
    return file
