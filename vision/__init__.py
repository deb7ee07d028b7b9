"""Vision: detection of coloured cylinders in camera images."""
