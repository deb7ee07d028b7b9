"""Walking pattern: ZMP and motion of the centre of mass from footholds."""
