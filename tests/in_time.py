"""Motions by an integration in time, in nm and us: a judge of those by energies."""

from scipy.integrate import solve_ivp

from asperity._jax import jax, jnp


def next_turn(contact, body, memory, start, sign, film=None, until=None):
    """Place, time and speed of the next turn of a body at rest, or of where it passes a place."""
    force = jax.jit(lambda d: contact.state(d, memory).force)
    drag = jax.jit(lambda gap: jnp.asarray(0.0 if film is None else film.drag(gap)))
    mass, weight = float(body.mass), float(body.weight)

    def rate(_, y):
        place = y[0] * 1e-9
        pull = (float(force(place)) - weight) / mass - float(drag(place)) / mass * y[1] * 1e-3
        return [y[1], pull * 1e-3]

    def ends(_, y):
        return y[1] if until is None else y[0] - until * 1e9

    ends.terminal, ends.direction = True, -sign if until is None else 0
    method = "DOP853" if until is None else "Radau"
    rtol, atol = (1e-10, 1e-12) if until is None else (1e-8, 1e-25)
    start = [start * 1e9, sign * 1e-9]
    answer = solve_ivp(rate, (0, 1e20), start, method, events=ends, rtol=rtol, atol=atol)
    place, speed = answer.y_events[0][0]
    return place * 1e-9, answer.t_events[0][0] * 1e-6, abs(speed) * 1e-3
