// SPDX-License-Identifier: Zlib
//
// Draws the charts of a report. A figure holds its chart as JSON; all numbers are in a table beside
// it, so that a page whose charts cannot be drawn still says everything.

(async () => {
    const options = {
        ast: true, // without it, expressions are compiled by eval, which the page's policy forbids
        actions: false,
        renderer: "svg",
        defaultStyle: false,
        tooltip: { disableDefaultStyle: true, theme: "page" },
    };
    const figures = [...document.querySelectorAll("figure.chart")];
    const charts = figures.map((figure) => JSON.parse(figure.querySelector("script").textContent));
    const looks = looksOf(charts);
    for (const [i, figure] of figures.entries()) {
        const drawing = figure.querySelector(".drawing");
        try {
            await vegaEmbed(drawing, chartSpec(charts[i], looks), options);
            figure.dataset.drawn = "yes";
        } catch (error) {
            drawing.textContent = `This chart could not be drawn: ${error.message}`;
            figure.dataset.drawn = "no";
        }
    }
    document.documentElement.dataset.charts = "done";
})();
