// comparison.js: the panel that measures: errors by every metric, the reference, and the plot of error against time.

import {make} from "./elements.js";
import {Feed} from "./feed.js";
import {short} from "./numbers.js";
import {plotErrors} from "./plot.js";
import * as server from "./server.js";

function referenceText(reference) {
    if (reference.kind === "path_tracer")
        return `path tracer, pass ${reference.passes} of ${reference.passes_wanted}`;
    return reference.kind === "view" ? "a picture of A" : `file ${reference.file}`;
}

// What is measured: each view against the reference, where there is one, else A against B.
function pairsOf(state) {
    const views = ["a", "b"].filter((view) => state.views[view]?.picture > 0 && !state.views[view].preview);
    if (state.reference)
        return state.reference.picture > 0 ? views.map((of) => ({of, against: "reference"})) : [];
    return views.length === 2 ? [{of: "a", against: "b"}] : [];
}

const nothing_to_measure = "It takes a second view (Compare) or a reference, and a first pass of each.";

function measure({layer, pairs}) {
    return Promise.all(pairs.map(({of, against}) => server.get(
        `compare?layer=${encodeURIComponent(layer)}&of=${of}&against=${against}`)));
}

export class Comparison {
    // Elements of the panel by their names: metrics, metrics_caption, metrics_empty, plot, plot_empty, plot_legend,
    // reference_form, reference_kind, reference_file, reference_samples, reference_state, reference_error,
    // reference_drop.
    constructor(elements) {
        this.elements = elements;
        this.state = null;
        this.metrics = new Feed(measure, (answers, wanted) => this.showMetrics(answers, wanted),
            (problem, wanted) => this.showMetrics([], wanted, problem.message));
        this.measured = null; // the layer and pairs that the table is of
        this.history = new Feed(() => server.get("history"), (answer) => this.showHistory(answer));
        this.listen();
        new ResizeObserver(() => this.last_history && this.showHistory(this.last_history)).observe(elements.plot);
    }

    listen() {
        const {reference_form, reference_kind, reference_drop} = this.elements;
        const kindChanged = () => {
            this.elements.reference_file.parentElement.hidden = reference_kind.value !== "file";
            this.elements.reference_samples.parentElement.hidden = reference_kind.value !== "path_tracer";
        };
        reference_kind.addEventListener("change", kindChanged);
        kindChanged();
        reference_form.addEventListener("submit", (event) => {
            event.preventDefault();
            this.ask(() => server.put("reference", this.wantedReference()));
        });
        reference_drop.addEventListener("click", () => this.ask(() => server.remove("reference")));
    }

    wantedReference() {
        const {reference_kind, reference_file, reference_samples} = this.elements;
        if (reference_kind.value === "file")
            return {file: reference_file.value.trim()};
        if (reference_kind.value === "view")
            return {view: "a"};
        return {path_tracer: {samples: Number(reference_samples.value)}};
    }

    async ask(request) {
        const error = this.elements.reference_error;
        try {
            await request();
            error.hidden = true;
        } catch (problem) {
            error.textContent = problem.message;
            error.hidden = false;
        }
    }

    // Asks for what the state makes out of date; `layer` is what is shown.
    show(state, layer) {
        this.state = state;
        const {a, b} = state.views, reference = state.reference;
        const {reference_state, reference_drop, metrics_caption} = this.elements;
        reference_state.textContent = reference ? referenceText(reference) : "none";
        if (reference?.error)
            reference_state.textContent += `: ${reference.error.message ?? reference.error}`;
        reference_drop.hidden = !reference;
        metrics_caption.textContent = `${reference ? "Against the reference" : "A against B"}: ${layer}`;
        const pairs = pairsOf(state), numbers = [a.picture, b?.picture, reference?.picture];
        if (pairs.length > 0)
            this.wantMetrics({layer, pairs, numbers});
        else
            this.showMetrics([], {layer, pairs});
        if (reference)
            this.history.want({serial: state.serial});
        else
            this.showHistory({a: [], b: []});
    }

    // Numbers of another layer, or of other pairs, are gone before the new ones are there.
    wantMetrics(wanted) {
        if (this.measured !== JSON.stringify([wanted.layer, wanted.pairs]))
            this.showMetrics([], wanted, "Measuring.");
        this.metrics.want(wanted);
    }

    // One column for each pair; `message` says why there are none.
    showMetrics(answers, {layer, pairs}, message = nothing_to_measure) {
        this.measured = JSON.stringify([layer, pairs]);
        const {metrics: table, metrics_empty} = this.elements;
        const head = make("tr", {}, make("td"), ...pairs.map(({of, against}) => make("th", {scope: "col", class: of},
            against === "reference" ? of.toUpperCase() : "A, B")));
        const rows = (answers[0]?.metrics || []).map((metric, i) => make("tr", {},
            make("th", {scope: "row", title: metric.help || null},
                metric.unit ? `${metric.name}, ${metric.unit}` : metric.name),
            ...answers.map(({metrics}) => metrics[i].value).map(
                (value) => make("td", {}, value === null ? "–" : short(value)))));
        table.replaceChildren(...rows.length > 0 ? [head, ...rows] : []);
        metrics_empty.textContent = message;
        metrics_empty.hidden = rows.length > 0;
    }

    showHistory(history) {
        this.last_history = history;
        const names = {};
        for (const view of ["a", "b"])
            names[view] = this.state?.views[view]?.strategies.estimator || "";
        const shown = {a: history.a, b: this.state?.views.b ? history.b : []};
        const drawn = plotErrors(this.elements.plot, shown, names);
        this.elements.plot_empty.hidden = drawn;
        this.elements.plot_legend.replaceChildren(...["a", "b"].filter((view) => shown[view]?.length > 0).map(
            (view) => make("span", {class: `key ${view}`}, `${view.toUpperCase()} ${names[view]}`)));
    }
}
