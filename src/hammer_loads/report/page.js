// Charts by dygraphs: bands of least and greatest, zoom together within a group, keys for those without a mouse.
(function () {
  'use strict';
  var charts = JSON.parse(document.getElementById('charts').textContent);
  var groups = {};
  var palette = ['#2a78c8', '#cc6a1e', '#3b9150', '#a0519f', '#b03a3a', '#7a7f1f', '#1f8a8f', '#7a6ad0'];

  function rowsOf(chart, rows) {
    if (chart.base_ms === undefined) return rows;
    return rows.map(function (row) { return [new Date(chart.base_ms + 1000 * row[0])].concat(row.slice(1)); });
  }

  // dygraphs takes a formatter's text as HTML.
  function escaped(words) {
    return words.replace(/[&<>"']/g, function (c) { return '&#' + c.charCodeAt(0) + ';'; });
  }

  function two(n) { return (n < 10 ? '0' : '') + n; }

  // As the reader's clock shows it; the day only where it is another one than in UTC.
  function localText(moment, to) {
    var day = moment.getFullYear() + '-' + two(moment.getMonth() + 1) + '-' + two(moment.getDate());
    var time = two(moment.getHours()) + ':' + two(moment.getMinutes()) + (to === 'seconds' ? ':' + two(moment.getSeconds()) : '');
    return (day === moment.toISOString().slice(0, 10) ? '' : day + ' ') + time + ' local';
  }

  document.querySelectorAll('time[datetime]').forEach(function (place) {
    var beside = document.createElement('span');
    beside.className = 'local';
    beside.textContent = ' (' + localText(new Date(place.getAttribute('datetime')), place.getAttribute('data-to')) + ')';
    place.appendChild(beside);
  });

  function numberText(value, unit) {
    if (value === null || value === undefined) return '\u2013';
    return Number(value.toPrecision(4)) + (unit ? ' ' + escaped(unit) : '');
  }

  function optionsOf(chart, unit) {
    var dated = chart.base_ms !== undefined;
    return {
      customBars: true, labelsUTC: true, labels: [dated ? 'time (UTC)' : 'time'].concat(chart.labels),
      colors: palette, strokeWidth: 1.5, fillAlpha: 0.22, gridLineColor: 'rgba(128,128,128,0.35)',
      axisLineColor: 'rgba(128,128,128,0.8)', connectSeparatedPoints: false, animatedZooms: false,
      legend: 'always', labelsSeparateLines: false, highlightCircleSize: 3, digitsAfterDecimal: 4,
      axes: { y: { axisLabelWidth: 52, valueFormatter: function (v) { return numberText(v, unit); } },
              x: { pixelsPerLabel: 76, axisLabelWidth: 72, valueFormatter: function (v) {
                return dated ? new Date(v).toISOString().slice(0, 19).replace('T', ' ') + ' UTC, ' + localText(new Date(v), 'seconds') : numberText(v);
              } } }
    };
  }

  function window_(graph) { return graph.xAxisRange(); }

  function show(group, range) {
    groups[group].forEach(function (graph) { graph.updateOptions({ dateWindow: range }); });
  }

  // Arrow keys move, plus and minus zoom, 0 shows everything.
  function onKey(group, graph, event) {
    var range = window_(graph), all = graph.xAxisExtremes(), width = range[1] - range[0], middle = (range[0] + range[1]) / 2;
    var moves = {
      ArrowLeft: function () { return [range[0] - 0.2 * width, range[1] - 0.2 * width]; },
      ArrowRight: function () { return [range[0] + 0.2 * width, range[1] + 0.2 * width]; },
      '+': function () { return [middle - width / 4, middle + width / 4]; },
      '-': function () { return [Math.max(all[0], middle - width), Math.min(all[1], middle + width)]; },
      '0': function () { return null; }
    };
    if (!moves[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    show(group, moves[event.key]());
  }

  charts.forEach(function (chart, at) {
    var place = document.getElementById('chart' + at);
    var first = chart.choices ? chart.choices[0] : chart;
    var options = optionsOf(chart, first.unit), settling = false;
    options.labelsDiv = document.getElementById('legend' + at);
    options.zoomCallback = function (from, to) {
      if (settling) return;
      settling = true;
      groups[chart.group].forEach(function (other) { if (other !== graph) other.updateOptions({ dateWindow: [from, to] }); });
      settling = false;
    };
    var graph = new Dygraph(place, rowsOf(chart, first.rows), options);
    (groups[chart.group] = groups[chart.group] || []).push(graph);
    place.addEventListener('keydown', function (event) { onKey(chart.group, graph, event); });
    if (!chart.choices) return;
    var select = document.querySelector('select[data-chart="' + at + '"]');
    select.addEventListener('change', function () {
      var choice = chart.choices[select.selectedIndex], next = optionsOf(chart, choice.unit);
      graph.updateOptions({ file: rowsOf(chart, choice.rows), axes: next.axes, dateWindow: null,
                            labels: [next.labels[0], choice.label] });
    });
  });

  // On paper the charts are as wide as the sheet.
  window.addEventListener('beforeprint', function () {
    Object.keys(groups).forEach(function (group) { groups[group].forEach(function (graph) { graph.resize(); }); });
  });
})();
