"""The process: portable arithmetic, OpenGL, signals, its parent, compilation at first use."""
