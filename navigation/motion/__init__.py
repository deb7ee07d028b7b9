"""Motion: the belief becomes a velocity, by the modified univector field and what guards it."""
