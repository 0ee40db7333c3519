"""Figures by matplotlib. Each function returns a Figure, which a notebook shows and savefig() writes."""

import textwrap

import numpy

MEASURED, MODEL, SETPOINT, MOVES = "#0072b2", "#d55e00", "#009e73", "#333333"
OWN, OTHERS = "#d55e00", "#4c5866"
# With the styles, for 40 methods beside one's own.
COLOURS = ["#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#5d3a9b", "#7f7f7f", "#994f00", "#40b0a6", "#000000"]
STYLES = ["-", "--", ":", "-."]


def new(*shape, size, **options):
    """A figure that is shown once, by who returns it."""
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(*shape, figsize=size, squeeze=False, layout="constrained", **options)
    pyplot.close(figure)
    for each in axes.ravel():
        each.spines[["top", "right"]].set_visible(False)
        each.tick_params(labelsize=8)
    return figure, axes


def plain(text):
    """A name as it is: of an even number of '$' matplotlib would make a formula."""
    return text.replace("$", r"\$")


def loop(loop):
    """y, the model and the setpoint of each CV, then u and its target of each MV."""
    rows = [("cvs", i) for i in range(len(loop.cvs))] + [("mvs", i) for i in range(len(loop.mvs))]
    figure, axes = new(len(rows), 1, size=(7, 0.6 + 1.15 * len(rows)), sharex=True)
    for place, (axis, (kind, i)) in enumerate(zip(axes[:, 0], rows)):
        variable = loop.context[kind][i]
        lines = ([("y_set", "setpoint", SETPOINT, "-"), ("y", "measured", MEASURED, "-"),
                  ("y_sim", "model", MODEL, "--")] if kind == "cvs" else
                 [("u", "moves", MOVES, "-"), ("u_target", "target", SETPOINT, ":")])
        for name, label, colour, style in lines:
            values = getattr(loop, name)
            if values.size and numpy.isfinite(values[i]).any() and not (name == "y_set" and not values.any()):
                axis.plot(loop.time, values[i], style, color=colour, linewidth=0.9, label=label)
        unit = "" if variable["unit"] == "1" else f"\n[{variable['unit']}]"
        axis.set_ylabel(plain(variable["name"] + unit), fontsize=9)
        if place in (0, len(loop.cvs)):
            axis.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3, frameon=False, fontsize=8, borderaxespad=0)
    axes[-1, 0].set_xlabel(plain(f"time [{loop.time_unit}]"), fontsize=9)
    return figure


def board(rated, rates, highlight=()):
    """Dots with whiskers: a row a method, a panel for each of these rates that some method has."""
    found, headings = rated.intervals, rated.json["headings"]
    rates = [name for name in rates if name in found.index.get_level_values("rate")
             and found.xs(name, level="rate")["value"].notna().any()]
    highlight = [highlight] if isinstance(highlight, str) else highlight
    methods = rated.methods[::-1]
    figure, axes = new(1, len(rates), size=(1.2 + 1.75 * len(rates), 0.9 + 0.24 * len(methods)), sharey=True)
    for axis, rate in zip(axes[0], rates):
        for row, method in enumerate(methods):
            colour = OWN if method in highlight else OTHERS
            if (method, rate) in found.index and found.loc[(method, rate), "value"] is not None:
                value, lower, upper = found.loc[(method, rate), ["value", "lower", "upper"]].astype(float) * 100
                if numpy.isfinite(value):
                    axis.plot([lower, upper], [row, row], color=colour, linewidth=1.6)
                    axis.plot(value, row, "o", color=colour, markersize=4.5)
        axis.set_xlim(-3, 103)
        axis.set_xticks([0, 50, 100])
        axis.grid(axis="both", color="#e3e6ea", linewidth=0.7)
        axis.set_axisbelow(True)
        axis.set_title(textwrap.fill(headings[rate], 18), fontsize=9)
        axis.set_xlabel("% of loops", fontsize=8)
    axes[0, 0].set_yticks(range(len(methods)), methods, fontsize=8)
    for label in axes[0, 0].get_yticklabels():
        if label.get_text() in highlight:
            label.set(color=OWN, fontweight="bold")
    return figure


def reliability(bins, methods=None):
    """A panel a method: how often the likeliest source is the truth, by the probability that the method states for it."""
    methods = list(dict.fromkeys(bins.index.get_level_values("method"))) if methods is None else list(methods)
    if not methods:
        raise ValueError("no method of this board states probabilities")
    columns = min(3, len(methods))
    figure, axes = new(-(-len(methods) // columns), columns, size=(2.6 * columns, 2.7 * -(-len(methods) // columns)))
    for axis, method in zip(axes.ravel(), methods):
        points = 100 * bins.loc[method, ["stated", "value", "lower", "upper"]].astype(float)
        axis.plot([0, 100], [0, 100], "--", color="#c8ccd2", linewidth=0.8)
        axis.errorbar(points["stated"], points["value"], yerr=[points["value"] - points["lower"], points["upper"] - points["value"]],
                      fmt="o", color=MEASURED, markersize=4, linewidth=1.2)
        for (_, point), loops in zip(points.iterrows(), bins.loc[method, "total"]):
            axis.annotate(str(loops), (point["stated"], point["upper"]), xytext=(0, 2), textcoords="offset points", ha="center",
                          fontsize=6)
        axis.set(xlim=(-3, 103), ylim=(-3, 112), xticks=[0, 50, 100], yticks=[0, 50, 100])
        axis.set_title(plain(method), fontsize=9)
        axis.set_xlabel("stated [%]", fontsize=8)
    for axis in axes.ravel()[len(methods):]:
        axis.set_visible(False)
    axes[0, 0].set_ylabel("is the truth [%]", fontsize=8)
    return figure


def roc(comparison, truth="impact", highlight=()):
    """ROC curves, those to highlight thick and on top."""
    highlight = [highlight] if isinstance(highlight, str) else highlight
    figure, axes = new(1, 1, size=(6, 4))
    axis = axes[0, 0]
    others = [method for method in comparison.methods if method not in highlight]
    looks = {method: (COLOURS[i % len(COLOURS)], STYLES[i // len(COLOURS) % len(STYLES)], 1.0)
             for i, method in enumerate(others)}
    looks |= {method: (OWN, STYLES[i % len(STYLES)], 2.2) for i, method in enumerate(highlight)}
    for method, (colour, style, width) in looks.items():
        curve = comparison.roc(method, truth)
        if not curve.empty:
            axis.plot(100 * curve["false_positive_rate"], 100 * curve["true_positive_rate"], label=method, color=colour,
                      linestyle=style, linewidth=width)
    axis.plot([0, 100], [0, 100], color="#c8ccd2", linewidth=0.8, zorder=0)
    axis.set_xlabel("loops without it that are flagged [%]", fontsize=9)
    axis.set_ylabel(f"loops with {'an impact' if truth == 'impact' else 'a fault'} that are flagged [%]", fontsize=9)
    axis.set_aspect("equal")
    if axis.get_legend_handles_labels()[0]:
        axis.legend(loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False, fontsize=8)
    return figure


def steps(repair):
    """Step responses of a channel: the model of the controller, and the corrected one."""
    channel = next(each for each in repair.context["model"]["transfer_functions"]
                   if (each["cv"], each["input"]) == (repair.cv, repair.mv))
    old, new_one = ((of["numerator"], of["denominator"], of["dead_time"])
                    for of in (channel, repair.json["transfer_function"]))
    slowest = max(settling_time(each) for each in (old, new_one))
    time = numpy.linspace(0, slowest, 400)
    figure, axes = new(1, 1, size=(6, 3))
    axis = axes[0, 0]
    axis.plot(time, step_response(*old, time), "--", color=MEASURED, linewidth=1.4, label="model of the controller")
    axis.plot(time, step_response(*new_one, time), color=OWN, linewidth=1.4, label="corrected")
    units = {each["name"]: each["unit"] for kind in ("cvs", "mvs") for each in repair.context[kind]}
    axis.set_xlabel(plain(f"time [{repair.context['time_unit']}]"), fontsize=9)
    axis.set_ylabel(plain(f"{repair.cv} [{units[repair.cv]}]"), fontsize=9)
    axis.set_title(plain(f"Unit step of {repair.mv}"), fontsize=10)
    axis.legend(frameon=False, fontsize=8)
    return figure


def settling_time(channel):
    """Dead time and five times the slowest time constant."""
    poles = numpy.roots(channel[1])
    slow = [5 / abs(pole.real) for pole in poles if pole.real < 0]
    return channel[2] + max([*slow, 1e-9])


def step_response(numerator, denominator, dead_time, time):
    """Response to a unit step at 0, from the state space of the transfer function: exact on an even grid."""
    denominator = numpy.asarray(denominator, float)
    numerator = numpy.asarray(numerator, float) / denominator[0]
    denominator = denominator / denominator[0]
    order = len(denominator) - 1
    numerator = numpy.concatenate([numpy.zeros(order + 1 - len(numerator)), numerator])
    through, output = numerator[0], numerator[1:] - numerator[0] * denominator[1:]
    # states and the input, which is constant
    system = numpy.zeros((order + 1, order + 1))
    if order:
        system[0, :order] = -denominator[1:]
        system[0, order] = 1
        system[1:order, :order - 1] = numpy.eye(order - 1)
    response = numpy.zeros(len(time))
    late = time[time >= dead_time] - dead_time
    if len(late):
        start = exponential(system * late[0]) @ numpy.append(numpy.zeros(order), 1.0)
        transition = exponential(system * (time[1] - time[0]))
        for place in range(len(time) - len(late), len(time)):
            response[place] = output @ start[:order] + through
            start = transition @ start
    return response


def exponential(matrix):
    """exp(matrix) by scaling, a Taylor series and squaring."""
    halvings = max(0, int(numpy.ceil(numpy.log2(max(numpy.abs(matrix).sum(axis=1).max(), 1e-300)))) + 4)
    small, result, term = matrix / 2.0 ** halvings, numpy.eye(len(matrix)), numpy.eye(len(matrix))
    for power in range(1, 12):
        term = term @ small / power
        result = result + term
    for _ in range(halvings):
        result = result @ result
    return result
