"""Feedback gain of the DCM from where its closed loop is wanted to be."""


def dcm_gain(omega: float, lag: float, rate: float) -> float:
    """ZMP moved per error of the DCM so that the error fades with e^{-rate t}.

    The error follows ξ' = ω (ξ - p), the ZMP follows the ankles' setpoints u with the servo's
    lag, p' = (u - p) / T (Morisawa et al., Humanoids 2014). Of the two poles of u = k ξ their
    sum is ω - 1/T whatever the gain; one is placed at `-rate`, which leaves the other one to the
    servo. Without a lag, this is the usual 1 + rate / ω.

    Args:
        omega: of the pendulum [1/s].
        lag: T of the servos [s].
        rate: wanted [1/s]; where the servo is too slow for it, both poles are put where they meet.
    """
    if lag > 0.0:
        rate = min(rate, max(0.0, 0.5 * (1.0 / lag - omega)))
    return (1.0 + rate / omega) * (1.0 - lag * rate)
