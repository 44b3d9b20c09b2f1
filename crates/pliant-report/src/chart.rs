//! Line charts over steps, as in figures 3 and 4 of the paper: on the page, and as SVG for a paper.

use crate::MARK;
use crate::colours::of_line;
use crate::escape::escape;
use serde::Serialize;
use std::fmt::Write;

/// A step is an outlier if it is more than this many times as high as nine of ten are.
const FAR: f64 = 3.0;
/// Fewest steps among which outliers are looked for.
const FEWEST: usize = 3;
/// Unit of times. Outliers among other figures are results, not noise of a busy machine.
const TIME: &str = "ms";

/// A chart: one figure a step for each of its lines.
#[derive(Clone, Debug, Serialize)]
pub struct Chart {
    /// Title of the chart.
    pub title: String,
    /// Unit of the figures, such as `ms`.
    pub unit: String,
    /// Name of the steps: `step` or `frame`.
    pub along: String,
    /// Numbers of the steps.
    pub x: Vec<u32>,
    /// Lines of the chart.
    pub series: Vec<Series>,
}

/// One line of a chart.
#[derive(Clone, Debug, Serialize)]
pub struct Series {
    /// Name of the line.
    pub name: String,
    /// Values, one a step; one that is not finite is not drawn.
    pub values: Vec<f64>,
}

/// Size of the SVG, and margins around the plot, in user units.
const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 400.0;
const LEFT: f64 = 64.0;
const TOP: f64 = 40.0;
const RIGHT: f64 = 20.0;
const BOTTOM: f64 = 48.0;
const FONT: &str = r#"font-family="Helvetica, Arial, sans-serif" font-size="12" fill="black""#;
/// Top of the legend, and height of one of its lines.
const LEGEND: f64 = HEIGHT + 10.0;
const LEGEND_LINE: f64 = 18.0;

impl Chart {
    /// Whether the chart has a logarithmic axis: the largest median of a line is over fifty times
    /// the smallest.
    pub fn is_logarithmic(&self) -> bool {
        let medians: Vec<f64> = self
            .series
            .iter()
            .map(|series| {
                let mut sorted: Vec<f64> = series
                    .values
                    .iter()
                    .copied()
                    .filter(|x| x.is_finite())
                    .collect();
                sorted.sort_by(f64::total_cmp);
                sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
            })
            .filter(|&median| median > 0.0)
            .collect();
        let least = medians.iter().copied().fold(f64::INFINITY, f64::min);
        medians.iter().any(|&median| median > 50.0 * least)
    }

    /// Upper end of a chart of times that leaves out outliers: the highest of the other steps.
    ///
    /// `None` if no step is an outlier, or if leaving them out would gain little.
    pub fn ceiling(&self) -> Option<f64> {
        if self.unit != TIME {
            return None;
        }
        let steps = 0..self.x.len();
        let heights = steps.map(|step| self.highest(step).map_or(0.0, |(_, y)| y));
        let mut heights: Vec<f64> = heights.filter(|&height| height > 0.0).collect();
        heights.sort_by(f64::total_cmp);
        let most = *heights.last()?;
        let usual = heights[(heights.len() - 1) * 9 / 10];
        let within = heights.partition_point(|&height| height <= FAR * usual);
        let ceiling = heights[within - 1];
        (heights.len() >= FEWEST && most > 1.5 * ceiling).then_some(ceiling)
    }

    /// Highest line at a step, and its value.
    fn highest(&self, step: usize) -> Option<(&Series, f64)> {
        let values = self
            .series
            .iter()
            .filter_map(|series| Some((series, *series.values.get(step)?)));
        let values = values.filter(|(_, y)| y.is_finite());
        values.max_by(|(_, one), (_, other)| one.total_cmp(other))
    }

    /// Renders the chart as SVG for a paper, with a legend below.
    pub fn svg(&self) -> String {
        let rows = self.series.len().div_ceil(2) as f64;
        let height = LEGEND + rows * LEGEND_LINE;
        let axes = Axes::of(self);
        // Only a clipped line refers to the clip path.
        let clip = if axes.is_cut {
            r#" clip-path="url(#plot)""#
        } else {
            ""
        };
        let size = format!(r#"width="{WIDTH}" height="{height}" viewBox="0 0 {WIDTH} {height}""#);
        let mut svg = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" {size} {FONT}>
<!-- {MARK} -->
<title>{title}</title>
<text x="{LEFT}" y="20" font-size="14">{title}</text>
"#,
            title = escape(&self.title),
        );
        axes.draw(&mut svg, self);
        if axes.is_cut {
            let [width, height] = [WIDTH - LEFT - RIGHT, HEIGHT - BOTTOM - TOP];
            let size = format!(r#"width="{width}" height="{height}""#);
            let _ = writeln!(
                svg,
                r#"<clipPath id="plot"><rect x="{LEFT}" y="{TOP}" {size}/></clipPath>"#
            );
            axes.mark_outliers(&mut svg, self);
        }
        for (number, series) in self.series.iter().enumerate() {
            let (colour, dashes) = of_line(number);
            let dashes = dash_attribute(dashes);
            let points = self
                .x
                .iter()
                .zip(&series.values)
                .filter(|(_, y)| y.is_finite());
            let points: Vec<String> = points
                .map(|(&x, &y)| format!("{:.2},{:.2}", axes.x(f64::from(x)), axes.y(y)))
                .collect();
            let points = points.join(" ");
            let stroke = format!(r#"stroke="{colour}" stroke-width="1.5" stroke-linejoin="round""#);
            let _ = writeln!(
                svg,
                r#"<polyline fill="none" {stroke}{dashes}{clip} points="{points}"/>"#
            );
            let x = LEFT + (number % 2) as f64 * (WIDTH - LEFT - RIGHT) / 2.0;
            let y = LEGEND + (number / 2) as f64 * LEGEND_LINE;
            let stroke = format!(r#"stroke="{colour}" stroke-width="2"{dashes}"#);
            let _ = write!(
                svg,
                r#"<line x1="{x}" y1="{0}" x2="{1}" y2="{0}" {stroke}/>"#,
                y - 4.0,
                x + 24.0,
            );
            let _ = writeln!(
                svg,
                r#"<text x="{0}" y="{y}">{1}</text>"#,
                x + 32.0,
                escape(&series.name),
            );
        }
        svg.push_str("</svg>\n");
        svg
    }
}

/// Axes: the map from values to the picture.
struct Axes {
    x: [f64; 2],
    y: [f64; 2],
    logarithmic: bool,
    /// Distance of two horizontal grid lines.
    tick: f64,
    /// Whether some steps end above the picture.
    is_cut: bool,
}

impl Axes {
    fn of(chart: &Chart) -> Self {
        let logarithmic = chart.is_logarithmic();
        let ceiling = chart.ceiling().filter(|_| !logarithmic);
        let values = chart
            .series
            .iter()
            .flat_map(|series| &series.values)
            .copied();
        let values = values.filter(|&y| y.is_finite() && (!logarithmic || y > 0.0));
        let (least, most) = values.fold((f64::INFINITY, 0.0), |(least, most), y| {
            (f64::min(least, y), f64::max(most, y))
        });
        let most_shown = ceiling.unwrap_or(if most > 0.0 { most } else { 1.0 });
        let mut all = chart.series.iter().flat_map(|series| &series.values);
        // Counts have no halves.
        let least_tick = if all.all(|y| y.fract() == 0.0) {
            1.0
        } else {
            0.0
        };
        let tick = tick_size(most_shown).max(least_tick);
        let y = if logarithmic {
            [
                10_f64.powf(least.log10().floor()),
                10_f64.powf(most.log10().ceil()),
            ]
        } else {
            [0.0, (most_shown / tick).ceil() * tick]
        };
        let first = chart.x.iter().copied().min().unwrap_or(0);
        let last = chart.x.iter().copied().max().unwrap_or(1);
        Self {
            x: [
                f64::from(first),
                f64::from(last).max(f64::from(first) + 1.0),
            ],
            y,
            logarithmic,
            tick,
            is_cut: ceiling.is_some(),
        }
    }

    fn x(&self, x: f64) -> f64 {
        LEFT + (x - self.x[0]) / (self.x[1] - self.x[0]) * (WIDTH - LEFT - RIGHT)
    }

    fn y(&self, y: f64) -> f64 {
        let [low, high] = self.y;
        let part = if self.logarithmic {
            (y.max(low).log10() - low.log10()) / (high.log10() - low.log10())
        } else {
            (y - low) / (high - low)
        };
        HEIGHT - BOTTOM - part * (HEIGHT - BOTTOM - TOP)
    }

    fn draw(&self, svg: &mut String, chart: &Chart) {
        let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        for y in self.ticks_up() {
            let at = self.y(y);
            let _ = write!(
                svg,
                r##"<line x1="{LEFT}" y1="{at:.2}" x2="{right}" y2="{at:.2}" stroke="#ddd"/>"##,
            );
            let _ = writeln!(
                svg,
                r#"<text x="{0}" y="{1:.2}" text-anchor="end">{2}</text>"#,
                LEFT - 8.0,
                at + 4.0,
                short(y),
            );
        }
        let step = tick_size(self.x[1] - self.x[0]).max(1.0);
        let mut x = (self.x[0] / step).ceil() * step;
        while x <= self.x[1] {
            let at = self.x(x);
            let _ = write!(
                svg,
                r#"<line x1="{at:.2}" y1="{bottom}" x2="{at:.2}" y2="{0}" stroke="black"/>"#,
                bottom + 5.0,
            );
            let _ = writeln!(
                svg,
                r#"<text x="{at:.2}" y="{0}" text-anchor="middle">{x}</text>"#,
                bottom + 19.0,
            );
            x += step;
        }
        let _ = writeln!(
            svg,
            r#"<line x1="{LEFT}" y1="{bottom}" x2="{right}" y2="{bottom}" stroke="black"/>
<text x="{right}" y="{0}" text-anchor="end">{1}</text>
<text x="{2}" y="{TOP}" text-anchor="end" dy="-10">{3}</text>"#,
            bottom + 36.0,
            escape(&chart.along),
            LEFT - 8.0,
            escape(&chart.unit),
        );
    }

    /// Draws a triangle at the top for each outlier, with its highest line, and labels the highest
    /// of all.
    fn mark_outliers(&self, svg: &mut String, chart: &Chart) {
        let steps = chart.x.iter().enumerate();
        let above = steps.filter_map(|(step, &x)| Some((x, chart.highest(step)?)));
        let above: Vec<_> = above.filter(|&(_, (_, y))| y > self.y[1]).collect();
        let most = above.iter().map(|&(_, (_, y))| y).fold(0.0, f64::max);
        for (x, (series, y)) in above {
            let at = self.x(f64::from(x));
            let said = format!("{} {x}: {} {}", chart.along, short(y), chart.unit);
            let _ = writeln!(
                svg,
                r#"<path d="M{at:.2} {TOP} l6 10 h-12 z"><title>{}</title></path>"#,
                escape(&format!("{said}, {}", series.name))
            );
            if y < most {
                continue;
            }
            let (side, anchor) = if at < WIDTH / 2.0 {
                (10.0, "start")
            } else {
                (-10.0, "end")
            };
            let _ = writeln!(
                svg,
                r#"<text x="{:.2}" y="{}" text-anchor="{anchor}">{}</text>"#,
                at + side,
                TOP + 10.0,
                escape(&said)
            );
        }
    }

    fn ticks_up(&self) -> Vec<f64> {
        let [low, high] = self.y;
        if self.logarithmic {
            let decades = (high / low).log10().round() as i32;
            return (0..=decades)
                .map(|decade| low * 10_f64.powi(decade))
                .collect();
        }
        (0..=(high / self.tick).round() as u32)
            .map(|i| f64::from(i) * self.tick)
            .collect()
    }
}

/// Distance of ticks: 1, 2 or 5 times a power of ten, between four and ten of them in `range`.
fn tick_size(range: f64) -> f64 {
    let rough = range / 4.0;
    let power = 10_f64.powf(rough.log10().floor());
    [5.0, 2.0, 1.0]
        .into_iter()
        .map(|step| step * power)
        .find(|&step| step <= rough)
        .unwrap_or(power)
}

/// Shortest decimal form, without the rounding errors of sums of fractions.
fn short(y: f64) -> String {
    let text = format!("{y:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn dash_attribute(dashes: &[u8]) -> String {
    if dashes.is_empty() {
        return String::new();
    }
    let dashes: Vec<String> = dashes.iter().map(u8::to_string).collect();
    format!(r#" stroke-dasharray="{}""#, dashes.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(series: &[(&str, &[f64])]) -> Chart {
        Chart {
            title: "time <per> step".to_owned(),
            unit: "ms".to_owned(),
            along: "step".to_owned(),
            x: vec![10, 20, 30],
            series: series
                .iter()
                .map(|&(name, values)| Series {
                    name: name.to_owned(),
                    values: values.to_vec(),
                })
                .collect(),
        }
    }

    #[test]
    fn ticks_are_round_numbers() {
        for (range, tick) in [
            (1.0, 0.2),
            (4.0, 1.0),
            (3.9, 0.5),
            (200.0, 50.0),
            (0.663, 0.1),
            (39.9, 5.0),
        ] {
            assert!(
                (tick_size(range) - tick).abs() < 1e-12,
                "{range}: {}",
                tick_size(range)
            );
        }
        assert_eq!(
            [short(0.1 + 0.2), short(20.0), short(0.0)],
            ["0.3", "20", "0"]
        );
    }

    #[test]
    fn lines_far_apart_are_on_a_logarithmic_axis() {
        assert!(!chart(&[("a", &[1.0, 1.0, 9.0]), ("b", &[40.0, 50.0, 60.0])]).is_logarithmic());
        let far = chart(&[("a", &[1.0, 1.0, 9.0]), ("b", &[40.0, 51.0, 60.0])]);
        assert!(far.is_logarithmic());
        let axes = Axes::of(&far);
        assert_eq!(axes.ticks_up(), [1.0, 10.0, 100.0]);
        assert_eq!((axes.y(100.0), axes.y(1.0)), (TOP, HEIGHT - BOTTOM));
    }

    #[test]
    fn the_picture_has_every_point_in_its_place_and_no_name_is_markup() {
        let svg = chart(&[
            ("a & b", &[0.0, 2.0, 4.0]),
            ("</svg>", &[f64::NAN, 1.0, 1.0]),
        ])
        .svg();
        assert!(
            svg.contains(r#"points="64.00,352.00 382.00,196.00 700.00,40.00""#),
            "{svg}"
        );
        assert!(
            svg.contains(r#"points="382.00,274.00 700.00,274.00""#),
            "{svg}"
        );
        assert!(svg.contains("a &amp; b") && svg.contains("time &lt;per&gt; step"));
        assert_eq!(svg.matches("</svg>").count(), 1);
    }

    /// A chart of twenty steps and two lines. The first line begins with `values` and goes on at 1,
    /// the second is 0.5.
    fn beginning(values: &[f64]) -> Chart {
        let mut first = vec![1.0; 20];
        first[..values.len()].copy_from_slice(values);
        let mut chart = chart(&[("a & b", &first), ("c", &[0.5; 20])]);
        chart.x = (0..20).collect();
        chart
    }

    #[test]
    fn a_step_far_above_all_others_is_cut_off_marked_and_named() {
        let chart = beginning(&[2.0, 40.25]);
        assert_eq!(chart.ceiling(), Some(2.0));
        let svg = chart.svg();
        // The axis ends at 2. The line goes on beyond, and is clipped.
        let points = r#"clip-path="url(#plot)" points="64.00,40.00 97.47,-5927.00 130.95,196.00 "#;
        assert!(svg.contains(points), "{svg}");
        assert!(svg.contains(
            r#"<path d="M97.47 40 l6 10 h-12 z"><title>step 1: 40.25 ms, a &amp; b</title>"#
        ));
        assert!(svg.contains(r#"text-anchor="start">step 1: 40.25 ms</text>"#));
        assert_eq!(svg.matches("<title>step").count(), 1);
    }

    #[test]
    fn one_slow_step_flattens_no_chart_of_times() {
        // An outlier among three steps or more, anywhere; then beside two other slow steps.
        let ceiling = |steps: &[f64]| {
            let mut times = chart(&[("a", steps)]);
            times.x = (0..).take(steps.len()).collect();
            times.ceiling()
        };
        for count in 3..30 {
            for slow in 0..count {
                let mut steps = vec![1.0; count];
                steps[slow] = 40.0;
                assert_eq!(ceiling(&steps), Some(1.0), "{slow} of {count}");
            }
        }
        // Times of `run tear --stride 10`.
        let mut torn = [1.1; 25];
        (torn[0], torn[3], torn[15], torn[24]) = (11.9, 5.2, 5.3, 2.9);
        assert_eq!(ceiling(&torn), Some(5.3));
    }

    #[test]
    fn ticks_of_counts_are_whole() {
        for most in 1..30 {
            let mut few = chart(&[("a", &[0.0, f64::from(most)])]);
            assert!(
                Axes::of(&few).ticks_up().iter().all(|y| y.fract() == 0.0),
                "{most}"
            );
            few.series[0].values[0] = 0.5;
            assert_eq!(
                Axes::of(&few).ticks_up()[1].fract() != 0.0,
                most < 4,
                "{most}"
            );
        }
    }

    #[test]
    fn what_is_usual_is_not_cut_off() {
        // No outlier; then three of twenty, which are not few.
        for usual in [&[1.0, 2.9][..], &[2.5, 2.5, 7.4], &[9.0, 9.0, 9.0]] {
            let chart = beginning(usual);
            assert_eq!(chart.ceiling(), None, "{usual:?}");
            assert!(!chart.svg().contains("clip"));
        }
        // One step that is hardly above the next.
        let mut steps = [1.0; 60];
        steps[..2].copy_from_slice(&[2.9, 3.2]);
        let mut near = chart(&[("a", &steps)]);
        near.x = (0..60).collect();
        assert_eq!(near.ceiling(), None);
        near.series[0].values[1] = 4.4;
        assert_eq!(near.ceiling(), Some(2.9));
        // A line above the others at every step; steps without a value; few steps.
        let mut slow = beginning(&[]);
        slow.series[1].values = vec![30.0; 20];
        let mut rare = beginning(&[]);
        rare.series.pop();
        rare.series[0].values = vec![0.0; 20];
        rare.series[0].values[3..5].copy_from_slice(&[1.0, 9.0]);
        let few = chart(&[("a", &[1.0, 9.0])]);
        // Growth in counts is a result, and is shown.
        let mut found = beginning(&[9.0]);
        found.unit = "pairs".to_owned();
        let charts = [slow, rare, few, found];
        assert_eq!(charts.map(|chart| chart.ceiling()), [None; 4]);
        // A logarithmic axis shows all.
        let mut far = beginning(&[400.0]);
        far.series[1].values = vec![0.01; 20];
        assert!(far.ceiling().is_some() && far.is_logarithmic());
        assert!(!far.svg().contains("clip"));
    }

    #[test]
    fn nothing_and_zeros_are_drawn_too() {
        for series in [
            &[][..],
            &[("a", &[0.0; 3][..])],
            &[("a", &[f64::NAN; 3][..])],
        ] {
            let svg = chart(series).svg();
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        }
        let mut empty = chart(&[]);
        empty.x.clear();
        assert!(!empty.svg().contains("NaN"));
    }
}
