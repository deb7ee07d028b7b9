"""Tables of a run, in a folder or in memory: writing, reading, verification, differences."""
