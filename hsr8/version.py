"""Version of hsr8."""

VERSION = "0.1.0"
