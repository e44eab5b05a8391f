// SPDX-License-Identifier: Zlib
//
// Draws the charts of a report, as wide as the page. A figure holds its chart as JSON; all numbers are in a table
// below it, so that a page whose charts cannot be drawn has all of them.
//
// The document's data-charts is "done" when all charts are drawn for the present width.

(() => {
    const options = {
        ast: true, // without it, expressions are compiled by eval, which the page's policy forbids
        actions: false,
        renderer: "svg",
        defaultStyle: false,
        tooltip: { disableDefaultStyle: true, theme: "page" },
    };
    const figures = [...document.querySelectorAll("figure.chart")].map((element) => ({
        element,
        drawing: element.querySelector(".drawing"),
        chart: JSON.parse(element.querySelector("script").textContent),
        width: 0, // for which it is drawn
    }));
    const looks = looksOf(figures.map(({ chart }) => chart));

    // What is folded up has no width: it is drawn for that of the report, and again if it opens with another one.
    async function draw(figure) {
        const { element, drawing, chart } = figure;
        const width = drawing.clientWidth || figure.width || document.querySelector(".content").clientWidth;
        if (width === figure.width) {
            return;
        }
        figure.width = width;
        figure.embedded?.finalize();
        try {
            figure.embedded = await vegaEmbed(drawing, chartSpec(chart, looks, width), options);
            element.dataset.drawn = "yes";
        } catch (error) {
            drawing.textContent = `This chart could not be drawn: ${error.message}`;
            element.dataset.drawn = "no";
        }
    }

    let last = Promise.resolve();
    function drawAll() {
        last = last.then(async () => {
            for (const figure of figures) {
                await draw(figure);
            }
            document.documentElement.dataset.charts = "done";
        });
    }

    let timer;
    const observer = new ResizeObserver(() => {
        document.documentElement.dataset.charts = "waiting";
        clearTimeout(timer);
        timer = setTimeout(drawAll, 100); // [ms], not at each step while a window is dragged
    });
    figures.forEach(({ drawing }) => observer.observe(drawing));
    drawAll();
})();
