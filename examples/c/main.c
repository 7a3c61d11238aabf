/*
 * A pole on a cart, simulated and held upright by state feedback; README.md shows how to build it.
 *
 * The motion is integrated by the Runge-Kutta method of order 4 with steps of 1 ms. The controller samples the state
 * every 10 ms and holds its force in between: u = -K (p, th, v, w), where K minimises the sum of
 * 10 p^2 + 10 th^2 + v^2 + w^2 + u^2 over all samples.
 */

#include "cart_pole.h"

#include <math.h>
#include <stdio.h>

#define N CART_POLE_COORDINATES

static const double GAIN[2 * N] = {-2.9762, -35.7652, -4.0049, -7.8826};

/* Position and velocity. */
typedef struct state {
    double x[N];
    double xi[N];
} state;

/* The time derivative of a state. */
static cart_pole_status rate(const cart_pole_system *system, const state *at, const double *u, state *out)
{
    cart_pole_rate(system, at->x, at->xi, out->x);
    return cart_pole_accel(system, at->x, at->xi, u, out->xi);
}

/* at + h slope */
static state moved(const state *at, double h, const state *slope)
{
    state next;
    int i;
    for (i = 0; i < N; i++) {
        next.x[i] = at->x[i] + h * slope->x[i];
        next.xi[i] = at->xi[i] + h * slope->xi[i];
    }
    return next;
}

/* One step of the Runge-Kutta method of length h (s). */
static cart_pole_status step(const cart_pole_system *system, state *at, const double *u, double h)
{
    static const double place[4] = {0.0, 0.5, 0.5, 1.0};
    static const double weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    state slope = {{0.0, 0.0}, {0.0, 0.0}};
    state next = *at;
    int stage;
    for (stage = 0; stage < 4; stage++) {
        const state here = moved(at, h * place[stage], &slope);
        const cart_pole_status status = rate(system, &here, u, &slope);
        if (status != CART_POLE_STATUS_OK) {
            return status;
        }
        next = moved(&next, h * weight[stage], &slope);
    }
    *at = next;
    return CART_POLE_STATUS_OK;
}

static double feedback(const state *at)
{
    double u = 0.0;
    int i;
    for (i = 0; i < N; i++) {
        u -= GAIN[i] * at->x[i] + GAIN[N + i] * at->xi[i];
    }
    return u;
}

int main(void)
{
    cart_pole_parameters parameters;
    cart_pole_system system;
    cart_pole_status status;
    state at;
    double u[CART_POLE_INPUTS] = {0.0};
    double most = 0.0;
    int ms;

    cart_pole_default_parameters(&parameters);
    parameters.mp = 0.12; /* heavier than the controller assumes */
    status = cart_pole_set_parameters(&system, &parameters);
    cart_pole_start(at.x, at.xi);

    printf("    t/s      p/m   th/rad     F/N      E/J\n");
    for (ms = 0; ms <= 8000 && status == CART_POLE_STATUS_OK; ms++) {
        if (ms % 10 == 0) {
            u[CART_POLE_U_F] = feedback(&at);
            most = fmax(most, fabs(u[CART_POLE_U_F]));
        }
        if (ms % 1000 == 0) {
            printf("%7.1f %8.4f %8.4f %7.3f %8.4f\n", ms / 1000.0, at.x[CART_POLE_X_P], at.x[CART_POLE_X_TH],
                   u[CART_POLE_U_F], cart_pole_energy(&system, at.x, at.xi));
        }
        status = step(&system, &at, u, 1e-3);
    }
    if (status != CART_POLE_STATUS_OK) {
        fprintf(stderr, "no acceleration: status %d\n", (int)status);
        return 1;
    }
    printf("the largest force was %.2f N\n", most);
    /* The pole is upright, and the cart at the origin. */
    return fabs(at.x[CART_POLE_X_TH]) < 1e-3 && fabs(at.x[CART_POLE_X_P]) < 1e-2 ? 0 : 1;
}
