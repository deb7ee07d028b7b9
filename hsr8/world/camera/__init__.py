"""Head camera: rendered or analytic, with image noise and faults."""
