// panes.js: the pictures of the views as the page shows them: one, two side by side, two under a slider, their
// difference, or a map of what an eye would notice (FLIP).

import {magma_table, difference_table, paintDifference, paintLayer, paintMap, takesExposure} from "./colour.js";
import {Feed} from "./feed.js";
import {seconds, short} from "./numbers.js";
import * as server from "./server.js";
import {canvasOf, Place, Viewport} from "./viewport.js";

function addressOf({view, layer, picture}) {
    return `picture/${view}?layer=${encodeURIComponent(layer)}&picture=${picture}`;
}

// One view's picture: the newest samples of the layer that is shown, and its canvas.
class Shown {
    constructor(view, arrived) {
        this.view = view;
        this.picture = null;
        this.layer = null;
        this.image = null;
        this.painted = null;
        this.feed = new Feed((wanted) => server.getPicture(addressOf(wanted)), (picture, wanted) => {
            if (!picture)
                return;
            this.picture = picture;
            this.layer = wanted.layer;
            this.painted = null;
            arrived();
        });
    }

    drop() {
        this.picture = this.painted = null;
        this.feed.forget();
    }

    // Painted anew only where samples or exposure are others.
    paint(exposure) {
        const shown = takesExposure(this.layer) ? exposure : 0;
        if (this.painted !== shown) {
            this.image = canvasOf(paintLayer(this.picture, this.layer, shown), this.image);
            this.painted = shown;
        }
        return this.image;
    }

    // Its samples at (u, v), 0..1.
    at({u, v}) {
        const {width, height, channels, samples} = this.picture;
        const first = channels * (Math.floor(v * height) * width + Math.floor(u * width));
        return Array.from(samples.subarray(first, first + channels));
    }
}

function stageText(view) {
    const passes = view.passes > 0 && !view.preview ? `pass ${view.passes} of ${view.passes_wanted}` : view.stage;
    if (view.error || !passes)
        return "stopped";
    return `${view.preview ? "preview, " : ""}${passes} · ${seconds(view.seconds)} · ${seconds(view.cpu_seconds)} CPU`;
}

// What a map is of, but for the numbers of the pictures.
function pairText({layer, of, against}) {
    return [layer, of, against].join(" ");
}

export class Panes {
    // look: what this page shows, {layer, exposure, mode, split}; told(name) what of it the pointer changes.
    constructor(look, told) {
        this.look = look;
        this.told = told;
        this.place = new Place();
        this.pointer = null;
        this.state = null;
        this.due = false;
        this.map = null;
        this.map_image = this.difference_image = null;
        this.shown = {a: new Shown("a", () => this.arrived()), b: new Shown("b", () => this.arrived())};
        this.map_feed = new Feed(
            ({layer, of, against}) => server.getPicture(
                `compare_map?layer=${encodeURIComponent(layer)}&of=${of}&against=${against}&metric=flip`),
            (map, wanted) => {
                this.map = map;
                this.map_image = map && canvasOf(paintMap(map), this.map_image);
                this.map_is = {of: pairText(wanted), refusal: null};
                this.draw();
            },
            (problem, wanted) => {
                this.map = null;
                this.map_is = {of: pairText(wanted), refusal: problem.message};
                this.draw();
            });
        this.map_is = {of: null, refusal: null};
        this.figures = {};
        this.captions = {};
        this.viewports = {};
        for (const view of ["a", "b"])
            this.makePane(view);
        this.place.addEventListener("change", () => told("zoom"));
    }

    makePane(view) {
        const figure = document.querySelector(`.pane.${view}`);
        const viewport = new Viewport(figure.querySelector("canvas"), this.place);
        viewport.addEventListener("point", ({detail}) => {
            this.pointer = detail;
            this.told("point");
        });
        viewport.addEventListener("pick", ({detail}) => {
            this.pointer = detail;
            this.told("pick");
        });
        viewport.addEventListener("split", ({detail}) => {
            this.look.split = detail;
            this.told("split");
        });
        this.figures[view] = figure;
        this.captions[view] = figure.querySelector("figcaption");
        this.viewports[view] = viewport;
    }

    arrived() {
        this.draw();
        this.told("picture");
    }

    // All is fetched anew: the program may be another.
    forget() {
        for (const feed of [this.shown.a.feed, this.shown.b.feed, this.map_feed])
            feed.forget();
    }

    // The whole picture's size; a preview is smaller.
    frame(view = "a") {
        const [width, height] = (this.state.views[view].values.size || "1x1").split("x").map(Number);
        return {width, height};
    }

    // Ways to see what there is: [[value, text], ...].
    modes() {
        const has_two = Boolean(this.state.views.b);
        const found = has_two ? [["side", "side by side"], ["slider", "under a slider"],
            ["difference", "difference B − A"], ["flip", "FLIP of A and B"]] : [["single", "A alone"]];
        if (this.state.reference)
            found.push(["flip-a", "FLIP of A and reference"]);
        if (this.state.reference && has_two)
            found.push(["flip-b", "FLIP of B and reference"]);
        return found;
    }

    // The one that was chosen, if what is there allows it.
    mode() {
        const values = this.modes().map(([value]) => value);
        return values.includes(this.look.mode) ? this.look.mode : values[0];
    }

    // What a map is of, and whether both are there.
    compared() {
        const {a, b} = this.state.views, reference = this.state.reference, mode = this.mode();
        const [of, against] = {"flip-a": [a, reference], "flip-b": [b, reference]}[mode] || [a, b];
        return {
            of: mode === "flip-b" ? "b" : "a", against: against === reference ? "reference" : "b",
            numbers: [of.picture, against.picture],
            ready: of.picture > 0 && against.picture > 0 && !of.preview && !against.preview,
        };
    }

    showsMap() {
        return this.mode().startsWith("flip");
    }

    // A new state, or another look.
    show(state) {
        this.state = state;
        for (const view of ["a", "b"]) {
            const of_state = state.views[view];
            if (!of_state || this.lacksLayer(view))
                this.shown[view].drop();
            else if (of_state.picture > 0)
                this.shown[view].feed.want({view, layer: this.look.layer, picture: of_state.picture});
            this.caption(view);
        }
        this.layOut();
        const {of, against, numbers, ready} = this.showsMap() ? this.compared() : {};
        if (ready)
            this.map_feed.want({layer: this.look.layer, of, against, numbers});
        this.draw();
    }

    // A denoiser may make a layer that the other view's does not make, or that of the preview.
    lacksLayer(view) {
        const {picture, layers} = this.state.views[view];
        return picture > 0 && !layers.some(({name}) => name === this.look.layer);
    }

    // Where one pane shows both views, it has both captions.
    layOut() {
        const has_two_panes = this.mode() === "side", caption = this.captions.b;
        const home = this.figures[has_two_panes ? "b" : "a"].querySelector(".captions");
        if (caption.parentElement !== home)
            home.append(caption);
        caption.hidden = !this.state.views.b;
        this.figures.b.hidden = !has_two_panes;
    }

    caption(view) {
        const of_state = this.state.views[view], caption = this.captions[view];
        if (!of_state)
            return;
        caption.querySelector(".name").textContent =
            `${this.state.views.b ? `${view.toUpperCase()} · ` : ""}${of_state.strategies.estimator}`;
        caption.querySelector(".progress").textContent = stageText(of_state) +
            (this.lacksLayer(view) ? ` · has no layer ${this.look.layer}` : "");
        caption.querySelector("progress").value = of_state.fraction;
        this.viewports[view].canvas.setAttribute("aria-label",
            `view ${view.toUpperCase()}: ${of_state.strategies.estimator}, ${stageText(of_state)}`);
    }

    // Once a frame of the display at the most, as painting a large picture takes longer than that.
    draw() {
        if (this.due)
            return;
        this.due = true;
        requestAnimationFrame(() => {
            this.due = false;
            this.drawNow();
        });
    }

    drawNow() {
        if (!this.state)
            return;
        const {a, b} = this.shown, mode = this.mode(), exposure = this.look.exposure;
        const painted = (shown) => shown.picture && shown.paint(exposure);
        let images = mode === "slider" ? [painted(a), painted(b)] : [painted(a)];
        if (mode === "difference" || this.showsMap())
            images = [this.showsMap() ? this.presentMap() : this.difference()];
        this.viewports.a.show(images, this.frame(), this.look.split);
        if (mode === "side")
            this.viewports.b.show([painted(b)], this.frame("b"), 0.5);
    }

    // The map of what is compared now; null where it is one of something else.
    presentMap() {
        const {of, against, ready} = this.compared();
        return ready && this.map && this.map_is.of === pairText({layer: this.look.layer, of, against})
            ? this.map_image : null;
    }

    flipText() {
        if (!this.compared().ready)
            return "FLIP is drawn after the first pass.";
        return this.map_is.refusal ?? "FLIP: how much an eye notices when it flips between the two";
    }

    // The ends of the difference's colours, which the exposure moves.
    largestDifference() {
        return 0.25 * 2 ** -this.look.exposure;
    }

    difference() {
        const {a, b} = this.shown;
        const image = a.picture && b.picture && a.layer === b.layer &&
            paintDifference(a.picture, b.picture, this.largestDifference());
        if (!image)
            return null;
        this.difference_image = canvasOf(image, this.difference_image);
        return this.difference_image;
    }

    // What the colours of a map mean; null where pictures are shown as they are.
    legend() {
        const mode = this.mode();
        if (this.showsMap())
            return {table: magma_table, low: "0", high: "1", text: this.flipText()};
        if (mode !== "difference")
            return null;
        if (this.frame("a").width !== this.frame("b").width || this.frame("a").height !== this.frame("b").height)
            return {text: "The pictures have different sizes."};
        for (const view of ["a", "b"]) {
            if (this.lacksLayer(view))
                return {text: `View ${view.toUpperCase()} has no layer ${this.look.layer}.`};
        }
        const end = short(this.largestDifference());
        return {table: difference_table, low: `−${end}`, high: `+${end}`,
            text: `luminance of B minus A in ${this.look.layer}; the exposure changes the scale`};
    }

    // The samples under the pointer: {x, y, a: [...], b: [...]}, or null.
    values() {
        if (!this.pointer || !this.state)
            return null;
        const {width, height} = this.frame();
        const found = {x: Math.floor(this.pointer.u * width), y: Math.floor(this.pointer.v * height)};
        for (const view of ["a", "b"]) {
            if (this.shown[view].picture)
                found[view] = this.shown[view].at(this.pointer);
        }
        return found;
    }

    zoom() {
        return this.viewports.a.zoom();
    }

    zoomBy(factor) {
        this.place.zoomTo(this.zoom() * factor, this.frame());
    }

    panBy(dx, dy) {
        this.place.zoomTo(this.zoom(), this.frame(), this.place.u, this.place.v, -dx, -dy);
    }

    actualSize() {
        this.place.zoomTo(1 / (window.devicePixelRatio || 1), this.frame());
    }
}
