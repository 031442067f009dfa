// plot.js: error against CPU seconds, both logarithmic, of both views. An SVG whose colours are the style sheet's.

import {logTicks, short} from "./numbers.js";

const namespace = "http://www.w3.org/2000/svg";
const margin = {left: 54, right: 14, top: 12, bottom: 38};

function draw(name, attributes, text) {
    const element = document.createElementNS(namespace, name);
    for (const [key, value] of Object.entries(attributes))
        element.setAttribute(key, value);
    if (text !== undefined)
        element.textContent = text;
    return element;
}

// From the least to the largest, a little apart.
function rangeOf(values) {
    const low = Math.min(...values), high = Math.max(...values);
    const room = Math.max((high / low) ** 0.08, 1.15);
    return [low / room, high * room];
}

function scale([low, high], from, to) {
    return (value) => from + (Math.log(value / low) / Math.log(high / low)) * (to - from);
}

// At least so many pixels apart.
function thinned(ticks, position, least) {
    const kept = [];
    for (const tick of ticks) {
        if (kept.length === 0 || Math.abs(position(tick) - position(kept[kept.length - 1])) >= least)
            kept.push(tick);
    }
    return kept;
}

function percent(value) {
    return `${short(100 * value)} %`;
}

function drawAxes(svg, x, y, x_range, y_range, width, height) {
    const bottom = height - margin.bottom;
    for (const tick of thinned(logTicks(...x_range), x, 34)) {
        svg.append(draw("line", {class: "grid", x1: x(tick), x2: x(tick), y1: margin.top, y2: bottom}));
        svg.append(draw("text", {x: x(tick), y: bottom + 14, "text-anchor": "middle"}, short(tick)));
    }
    for (const tick of thinned(logTicks(...y_range), y, 16)) {
        svg.append(draw("line", {class: "grid", x1: margin.left, x2: width - margin.right, y1: y(tick), y2: y(tick)}));
        svg.append(draw("text", {x: margin.left - 6, y: y(tick) + 4, "text-anchor": "end"}, percent(tick)));
    }
    svg.append(draw("path", {class: "axis",
        d: `M${margin.left} ${margin.top}V${bottom}H${width - margin.right}`}));
    svg.append(draw("text", {x: (margin.left + width - margin.right) / 2, y: height - 6, "text-anchor": "middle"},
        "CPU seconds"));
}

// history: {a: [{passes, cpu_seconds, error}], b: [...]}; names: {a: "gather", ...}. Returns whether there was
// anything to draw.
export function plotErrors(svg, history, names) {
    const series = ["a", "b"].map((view) => [view, (history[view] || []).filter(
        ({cpu_seconds, error}) => cpu_seconds > 0 && error > 0)]).filter(([, points]) => points.length > 0);
    svg.replaceChildren();
    const points = series.flatMap(([, some]) => some);
    if (points.length === 0)
        return false;
    const width = Math.max(svg.clientWidth, 160), height = Math.max(svg.clientHeight, 90);
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const x_range = rangeOf(points.map((point) => point.cpu_seconds));
    const y_range = rangeOf(points.map((point) => point.error));
    const x = scale(x_range, margin.left, width - margin.right);
    const y = scale(y_range, height - margin.bottom, margin.top);
    drawAxes(svg, x, y, x_range, y_range, width, height);
    for (const [view, some] of series) {
        const d = some.map(({cpu_seconds, error}, i) =>
            `${i ? "L" : "M"}${x(cpu_seconds).toFixed(1)} ${y(error).toFixed(1)}`);
        svg.append(draw("path", {class: `line ${view}`, d: d.join("")}));
        for (const {cpu_seconds, error, passes} of some) {
            const dot = draw("circle", {class: `dot ${view}`, cx: x(cpu_seconds), cy: y(error), r: 3});
            dot.append(draw("title", {},
                `${view.toUpperCase()}, ${passes} passes: ${percent(error)} after ${short(cpu_seconds)} s`));
            svg.append(dot);
        }
    }
    svg.setAttribute("aria-label", `Error against CPU seconds: ${series.map(([view, some]) =>
        `${view.toUpperCase()} ${names[view]} ${percent(some[some.length - 1].error)}`).join(", ")}`);
    return true;
}
