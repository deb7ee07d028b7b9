"""Pole placement of the DCM feedback."""


def dcm_gain(omega: float, lag: float, rate: float) -> float:
    """Return the gain from DCM error to ZMP for an error that decays with e^{-rate t} [1].

    The error follows ξ' = ω (ξ - p), the ZMP follows the ankle setpoints u with the servo lag,
    p' = (u - p) / T (Morisawa et al., Humanoids 2014). The poles of u = k ξ sum to ω - 1/T for any
    gain; one is placed at `-rate`. Without lag the gain is the usual 1 + rate / ω.

    Args:
        omega: of the pendulum [1/s].
        lag: T of the servos [s].
        rate: wanted [1/s]; with a servo too slow for it, both poles are placed at their mean.
    """
    if lag > 0.0:
        rate = min(rate, max(0.0, 0.5 * (1.0 / lag - omega)))
    return (1.0 + rate / omega) * (1.0 - lag * rate)
