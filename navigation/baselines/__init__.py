"""Published planners behind the protocol of ours, for comparison."""
